#include "engine/io/remote/public_address.h"

#include <cstring>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

namespace reljef::io {
namespace {

TEST(PublicAddress, IsNoneOfThisMachineAndItsNetworkInAnyForm) {
    for (const char* address : {"127.0.0.1",
                                "127.255.0.9",
                                "0.0.0.0",
                                "10.1.2.3",
                                "172.16.0.1",
                                "172.31.255.255",
                                "192.168.1.1",
                                "169.254.169.254",
                                "100.64.0.1",
                                "192.0.0.8",
                                "198.18.0.1",
                                "224.0.0.1",
                                "255.255.255.255",
                                "::",
                                "::1",
                                "::127.0.0.1",
                                "::ffff:127.0.0.1",
                                "::ffff:10.0.0.1",
                                "64:ff9b::10.0.0.1",
                                "fe80::1",
                                "fc00::1",
                                "fdff::1",
                                "ff02::1",
                                "fec0::1",
                                "2001:db8::1",
                                "2001::1",
                                "2002:7f00:1::",
                                "localhost",
                                ""}) {
        EXPECT_FALSE(is_public(address)) << address;
    }
}

TEST(PublicAddress, IsThatOfAHostOnTheInternet) {
    for (const char* address : {"8.8.8.8", "172.15.0.1", "172.32.0.1", "100.128.0.1", "223.255.0.1",
                                "2606:4700::1111", "::ffff:8.8.8.8", "64:ff9b::8.8.8.8"}) {
        EXPECT_TRUE(is_public(address)) << address;
    }
}

TEST(PublicAddress, OfASocketIsThatOfItsText) {
    sockaddr_in four{};
    four.sin_family = AF_INET;
    sockaddr_in6 six{};
    six.sin6_family = AF_INET6;
    const auto is_public_socket = [](const auto& socket) {
        sockaddr_storage any{};
        std::memcpy(&any, &socket, sizeof(socket));
        return is_public(reinterpret_cast<const sockaddr&>(any));
    };
    for (const char* address : {"127.0.0.1", "8.8.8.8", "192.168.0.1"}) {
        ASSERT_EQ(inet_pton(AF_INET, address, &four.sin_addr), 1);
        EXPECT_EQ(is_public_socket(four), is_public(address)) << address;
    }
    for (const char* address : {"::1", "2606:4700::1111", "::ffff:127.0.0.1"}) {
        ASSERT_EQ(inet_pton(AF_INET6, address, &six.sin6_addr), 1);
        EXPECT_EQ(is_public_socket(six), is_public(address)) << address;
    }
    EXPECT_FALSE(is_public(sockaddr{}));
}

} // namespace
} // namespace reljef::io
