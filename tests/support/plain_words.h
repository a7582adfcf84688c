#pragma once

#include <array>

namespace reljef::test {

/// Phrases that make a reader whose first language is not English read twice.
inline constexpr std::array dialect_phrases{
    " told",      " tells",     " asked for",  " promise",  " so many", " of which",   " is to be",
    " are to be", " to be had", " where they", " what is ", " mended",  " is none of", " thereof",
};

} // namespace reljef::test
