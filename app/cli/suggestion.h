#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace reljef::cli {

/// How many letters are inserted, removed, replaced or swapped with their neighbour between two
/// words (optimal string alignment distance).
int edit_distance(std::string_view a, std::string_view b);

/// The known word that is most like an unknown one, the first of equals; none if more than a third
/// of its letters differ.
std::optional<std::string> similar_word(std::string_view unknown,
                                        std::span<const std::string> known);

/// "; did you mean WORD?", or nothing if no known word is similar.
std::string suggestion(std::string_view unknown, std::span<const std::string> known);

} // namespace reljef::cli
