#pragma once

#include <span>
#include <string_view>

namespace reljef::bench {

/// An embedded file of bench/page.
struct PagePart {
    std::string_view name; ///< "index.html"
    std::string_view text;
};
std::span<const PagePart> page_parts();

} // namespace reljef::bench
