#pragma once

#include <string>
#include <vector>

namespace reljef::test {

/// All places in a text where a regular expression (ECMAScript) matches: each the whole match, and
/// then its groups, empty where they match nothing. Compiled once: `<regex>` takes g++ 3 s a file.
std::vector<std::vector<std::string>> matches(const std::string& text,
                                              const std::string& expression);
/// The text without these places.
std::string without_matches(const std::string& text, const std::string& expression);

} // namespace reljef::test
