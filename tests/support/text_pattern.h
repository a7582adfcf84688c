#pragma once

#include <string>
#include <vector>

namespace reljef::test {

/// All places in a text where a regular expression (ECMAScript) matches: each the whole match, and
/// then its groups, empty where they match nothing. One file includes `<regex>`, which takes g++ 3
/// s.
std::vector<std::vector<std::string>> matches(const std::string& text,
                                              const std::string& expression);
/// The text without these places.
std::string without_matches(const std::string& text, const std::string& expression);

} // namespace reljef::test
