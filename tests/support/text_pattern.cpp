#include "tests/support/text_pattern.h"

#include <regex>

namespace reljef::test {

std::vector<std::vector<std::string>> matches(const std::string& text,
                                              const std::string& expression) {
    const std::regex pattern(expression);
    std::vector<std::vector<std::string>> all;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end;
         ++match) {
        all.emplace_back(match->begin(), match->end());
    }
    return all;
}

std::string without_matches(const std::string& text, const std::string& expression) {
    return std::regex_replace(text, std::regex(expression), "");
}

} // namespace reljef::test
