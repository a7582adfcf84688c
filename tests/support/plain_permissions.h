#pragma once

#include <cstdint>

namespace reljef::test {

/// For this thread and those it starts what permissions forbid is forbidden, also where tests run
/// as root, for the scope.
class PlainPermissions {
public:
    PlainPermissions();
    ~PlainPermissions();
    PlainPermissions(const PlainPermissions&) = delete;
    PlainPermissions& operator=(const PlainPermissions&) = delete;

private:
    std::uint32_t before_ = 0; // the first 32 capabilities in effect
};

} // namespace reljef::test
