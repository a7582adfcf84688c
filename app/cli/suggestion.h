#pragma once

#include <span>
#include <string>
#include <string_view>

namespace reljef::cli {

/// Number of insertions, removals, replacements and swaps of neighbours between two words (optimal
/// string alignment distance).
int edit_distance(std::string_view a, std::string_view b);

/// "; did you mean WORD?" for the most similar known word, the first of equals. Empty if more than
/// a third of the letters differ from every known word.
std::string suggestion(std::string_view unknown, std::span<const std::string> known);

} // namespace reljef::cli
