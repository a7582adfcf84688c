#include "app/cli/usage_error.h"

#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace reljef::cli {

void fail_usage(const std::string& message) {
    throw CLI::ValidationError(message);
}

std::string usage_text(const CLI::ParseError& error) {
    std::string text = error.what();
    const std::string kind = error.get_name();
    const auto before = [&](std::string_view words) { return text.substr(0, text.find(words)); };
    const auto after = [&](std::string_view words) {
        const std::size_t at = text.find(words);
        return at == std::string::npos ? std::string() : text.substr(at + words.size());
    };
    if (kind == "RequiredError") { // "TERRAIN is required"
        return fmt::format("no {} found, one was expected", before(" is required"));
    }
    if (kind == "RequiresError") { // "--look requires --eye"
        return fmt::format("{} found without {}, both were expected", before(" requires "),
                           after(" requires "));
    }
    if (kind == "ExcludesError") { // "--pose excludes --eye"
        return fmt::format("{} found beside {}, one of them was expected", before(" excludes "),
                           after(" excludes "));
    }
    if (kind == "ArgumentMismatch" &&
        text.ends_with(" missing")) { // "--fov: 1 required DEG missing"
        return fmt::format("{}: no value found, one was expected", before(": "));
    }
    if (kind == "ArgumentMismatch") { // "--fov: At Most 1 required but received 2"
        return fmt::format("{}: {} values found, one was expected", before(": "),
                           after("received "));
    }
    return text;
}

} // namespace reljef::cli
