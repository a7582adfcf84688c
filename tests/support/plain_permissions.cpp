#include "tests/support/plain_permissions.h"

#include <array>
#include <cstdlib>

#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace reljef::test {
namespace {

using Capabilities = std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3>;

Capabilities capabilities() {
    __user_cap_header_struct own{_LINUX_CAPABILITY_VERSION_3, 0};
    Capabilities found{};
    if (::syscall(SYS_capget, &own, found.data()) != 0) {
        std::abort();
    }
    return found;
}

void put_in_effect(std::uint32_t first) {
    __user_cap_header_struct own{_LINUX_CAPABILITY_VERSION_3, 0};
    Capabilities changed = capabilities();
    changed[0].effective = first;
    if (::syscall(SYS_capset, &own, changed.data()) != 0) {
        std::abort();
    }
}

constexpr std::uint32_t over_permissions = 1U << CAP_DAC_OVERRIDE | 1U << CAP_DAC_READ_SEARCH;

} // namespace

PlainPermissions::PlainPermissions() : before_(capabilities()[0].effective) {
    put_in_effect(before_ & ~over_permissions);
}

PlainPermissions::~PlainPermissions() {
    put_in_effect(before_);
}

} // namespace reljef::test
