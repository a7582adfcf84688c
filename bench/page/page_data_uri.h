#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace reljef::bench {

/// "data:image/png;base64,…" (RFC 2397, RFC 4648).
std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes);

} // namespace reljef::bench
