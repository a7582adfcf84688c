#include "engine/io/remote/public_address.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace reljef::io {
namespace {

struct Block4 {
    std::uint32_t first;
    int bits;
};

constexpr std::array<Block4, 15> special4{{
    {0x00000000, 8},  // 0.0.0.0: this network
    {0x0A000000, 8},  // 10.0.0.0: private
    {0x64400000, 10}, // 100.64.0.0: carriers
    {0x7F000000, 8},  // 127.0.0.0: loopback
    {0xA9FE0000, 16}, // 169.254.0.0: link-local
    {0xAC100000, 12}, // 172.16.0.0: private
    {0xC0000000, 24}, // 192.0.0.0: protocols
    {0xC0000200, 24}, // 192.0.2.0: documentation
    {0xC0586300, 24}, // 192.88.99.0: 6to4 relays
    {0xC0A80000, 16}, // 192.168.0.0: private
    {0xC6120000, 15}, // 198.18.0.0: benchmarks
    {0xC6336400, 24}, // 198.51.100.0: documentation
    {0xCB007100, 24}, // 203.0.113.0: documentation
    {0xE0000000, 4},  // 224.0.0.0: multicast
    {0xF0000000, 4},  // 240.0.0.0: reserved
}};

bool is_public4(std::uint32_t address) {
    return std::none_of(special4.begin(), special4.end(), [&](const Block4& block) {
        return ((address ^ block.first) >> (32 - block.bits)) == 0;
    });
}

using Bytes6 = std::array<std::uint8_t, 16>;

template <std::size_t count>
bool begins_with(const Bytes6& address, const std::array<std::uint8_t, count>& beginning) {
    return std::equal(beginning.begin(), beginning.end(), address.begin());
}

bool is_public6(const Bytes6& address) {
    constexpr std::array<std::uint8_t, 12> mapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
    constexpr std::array<std::uint8_t, 12> nat64{0, 0x64, 0xFF, 0x9B};
    if (begins_with(address, mapped) || begins_with(address, nat64)) {
        std::uint32_t last = 0;
        std::memcpy(&last, address.data() + 12, sizeof(last));
        return is_public4(ntohl(last));
    }
    const bool global_unicast = (address[0] & 0xE0U) == 0x20; // 2000::/3
    constexpr std::array<std::uint8_t, 4> documentation{0x20, 0x01, 0x0D, 0xB8};
    constexpr std::array<std::uint8_t, 2> in_ipv4{0x20, 0x02};      // 6to4
    constexpr std::array<std::uint8_t, 3> protocols{0x20, 0x01, 0}; // 2001::/23, with Teredo
    return global_unicast && !begins_with(address, documentation) &&
           !begins_with(address, in_ipv4) && !begins_with(address, protocols);
}

} // namespace

bool is_public(const sockaddr& address) {
    if (address.sa_family == AF_INET) {
        sockaddr_in own{};
        std::memcpy(&own, &address, sizeof(own));
        return is_public4(ntohl(own.sin_addr.s_addr));
    }
    if (address.sa_family == AF_INET6) {
        sockaddr_in6 own{};
        std::memcpy(&own, &address, sizeof(own));
        Bytes6 bytes{};
        std::memcpy(bytes.data(), &own.sin6_addr, bytes.size());
        return is_public6(bytes);
    }
    return false;
}

bool is_public(const char* address) {
    std::uint32_t four = 0;
    Bytes6 six{};
    if (::inet_pton(AF_INET, address, &four) == 1) {
        return is_public4(ntohl(four));
    }
    return ::inet_pton(AF_INET6, address, six.data()) == 1 && is_public6(six);
}

} // namespace reljef::io
