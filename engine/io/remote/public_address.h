#pragma once

struct sockaddr;

namespace reljef::io {

/// Whether an address is a public host's: IPv4 or IPv6, and neither loopback, private, link-local,
/// multicast nor reserved (IANA's special-purpose registries, RFC 6890). IPv6 addresses that hold
/// an IPv4 address count as that one.
bool is_public(const sockaddr& address);
/// As text: "127.0.0.1", "::1". False for other text.
bool is_public(const char* address);

} // namespace reljef::io
