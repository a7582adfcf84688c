#include "tests/architecture/word_rules.h"

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <string>
#include <utility>

#include "tests/support/plain_words.h"

namespace reljef::test {
namespace {

// A word between underscores or humps, and what it should be.
constexpr std::array<std::pair<const char*, const char*>, 12> words{{
    {"most", "max"},
    {"least", "min"},
    {"told", "a plain verb"},
    {"tell", "log, report or write"},
    {"fault", "error"},
    {"faults", "errors"},
    {"refuse", "fail"},
    {"wanted", "requested"},
    {"fineness", "resolution"},
    {"thinning", "subsampling"},
    {"promise", "error_bound"},
    {"misuse", "usage_error"},
}};

// "TileFault" and "tile_fault" are "tile", "fault".
std::set<std::string> parts_of(const std::string& name) {
    static const std::regex part("[A-Z]?[a-z0-9]+|[A-Z]+(?![a-z])");
    std::set<std::string> parts;
    for (std::sregex_iterator found(name.begin(), name.end(), part), end; found != end; ++found) {
        std::string text = found->str();
        std::transform(text.begin(), text.end(), text.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        parts.insert(text);
    }
    return parts;
}

} // namespace

Complaints dialect_names(const SourceFile& file) {
    static const std::regex identifier("\\b[A-Za-z_]\\w*");
    if (!file.path.ends_with(".cpp") && !file.path.ends_with(".h")) {
        return {};
    }
    const std::string code = code_of(file.text);
    std::set<std::string> names;
    for (std::sregex_iterator found(code.begin(), code.end(), identifier), end; found != end;
         ++found) {
        names.insert(found->str());
    }
    Complaints complaints;
    static const std::set<std::string> allowed{"at_least", "at_most", "Tell"}; // the last is GDAL's
    for (const std::string& name : names) {
        const auto parts = parts_of(name);
        for (const auto& [word, better] : words) {
            if (parts.contains(word) && !allowed.contains(name)) {
                complaints.push_back(file.path + " names " + name + ", " + better +
                                     " was expected");
            }
        }
    }
    return complaints;
}

Complaints dialect_comments(const SourceFile& file) {
    static const std::regex comment("//[^\n]*");
    if (!file.path.ends_with(".h")) {
        return {};
    }
    Complaints complaints;
    for (std::sregex_iterator found(file.text.begin(), file.text.end(), comment), end; found != end;
         ++found) {
        for (const char* const phrase : dialect_phrases) {
            if (found->str().find(phrase) != std::string::npos) {
                complaints.push_back(file.path + " says \"" + phrase + "\": " + found->str());
            }
        }
    }
    return complaints;
}

} // namespace reljef::test
