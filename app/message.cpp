#include "app/message.h"

#include <cstdio>

namespace reljef::app {

void tell(std::string_view text) noexcept {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

} // namespace reljef::app
