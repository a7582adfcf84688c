#pragma once

#include <array>

namespace reljef::test {

/// Phrases that a reader whose first language is not English reads twice.
inline constexpr std::array dialect_phrases{
    " told",     " tells",     " asked for", " promise",     " so many", " of which",
    " is to be", " are to be", " to be had", " where they ", " mended",  " thereof"};

} // namespace reljef::test
