#include "app/cli/parser.h"

#include <algorithm>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/suggestion.h"

namespace reljef::cli {
namespace {

constexpr const char* status_help =
    "Exit status: 0 success; 1 failure, or ended by Ctrl-C (SIGINT, SIGTERM or SIGHUP); 2 unknown "
    "or\nconflicting options: nothing was written. A second signal, half a second later, ends the "
    "program at once\nwith the status 128 plus its number; the next run removes its temporary "
    "files. "
    "Signals that are ignored\nat the start, as by nohup, stay ignored.\n"
    "Output files appear whole or not at all. A symbolic link stays: the file that it names is "
    "replaced or created.";

// Rejects empty values, which CLI11 accepts or misreads.
void check_texts(std::span<char*> texts) {
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string_view text = texts[i];
        if (text.empty()) {
            throw CLI::ValidationError(
                i == 0 ? std::string("an empty word found, a word was expected")
                       : fmt::format("an empty word found after '{}', a word was expected",
                                     texts[i - 1]));
        }
        if (text.starts_with("--") && text.ends_with("=")) {
            throw CLI::ValidationError(
                fmt::format("{} found, a value was expected after it", text));
        }
    }
}

std::vector<std::string> option_names(const CLI::App& arguments) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : arguments.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

} // namespace

Parser::Parser(const Program& program, Interrupt& interrupt)
    : program_(program), arguments_(std::make_unique<CLI::App>(program.description, program.name)) {
    arguments_->set_version_flag("-V,--version", version_text());
    arguments_->require_subcommand(1);
    arguments_->footer(program.footer + "\n" + status_help);
    for (const auto add : program.commands) {
        commands_.push_back(add(*arguments_, interrupt));
    }
}

Parser::~Parser() = default;

const Command* Parser::named(std::string_view verb) const {
    const auto found = std::find_if(commands_.begin(), commands_.end(), [&](const Command& one) {
        return one.arguments->get_name() == verb;
    });
    return found == commands_.end() ? nullptr : &*found;
}

void Parser::check_verb(std::span<char*> texts) const {
    const std::string_view found = texts.empty() ? "" : texts[0];
    if (named(found) != nullptr) {
        return;
    }
    if (found.starts_with('-')) {
        if (arguments_->get_option_no_throw(std::string(found)) == nullptr) {
            throw CLI::ValidationError(fmt::format("{} found, a {} or an option was expected{}",
                                                   found, program_.verb,
                                                   suggestion(found, option_names(*arguments_))));
        }
        return;
    }
    std::vector<std::string> verbs;
    for (const Command& command : commands_) {
        verbs.push_back(command.arguments->get_name());
    }
    throw CLI::ValidationError(
        texts.empty() ? fmt::format("no {} found, one of {} was expected", program_.verb,
                                    fmt::join(verbs, ", "))
                      : fmt::format("{} '{}' found, one of {} was expected{}", program_.verb, found,
                                    fmt::join(verbs, ", "), suggestion(found, verbs)));
}

const Command& Parser::parse(std::span<char*> texts) {
    check_texts(texts);
    const bool wants_help = !texts.empty() && std::string_view(texts[0]) == "help";
    if (wants_help) {
        texts = texts.subspan(1);
        if (texts.empty()) {
            throw CLI::CallForHelp();
        }
    }
    check_verb(texts);
    const std::string_view first_text = texts[0];
    const bool is_alone = wants_help || first_text == "-V" || first_text == "--version";
    if (is_alone && texts.size() > 1) {
        throw CLI::ValidationError(
            fmt::format("'{}' found after '{}', nothing was expected there", texts[1], first_text));
    }
    std::vector<std::string> reversed(texts.rbegin(), texts.rend());
    if (wants_help) {
        reversed = {"--help", texts[0]};
    }
    try {
        arguments_->parse(reversed);
    } catch (const CLI::ExtrasError&) {
        const Command* const command = named(texts[0]);
        const CLI::App& parsed = command != nullptr ? *command->arguments : *arguments_;
        const std::vector<std::string> extras = arguments_->remaining(true);
        const std::string first = extras.empty() ? std::string(texts[0]) : extras.front();
        throw CLI::ValidationError(fmt::format("{}: {} found, a known option was expected{}",
                                               texts[0], first,
                                               suggestion(first, option_names(parsed))));
    }
    return *std::find_if(commands_.begin(), commands_.end(),
                         [](const Command& one) { return one.arguments->parsed(); });
}

} // namespace reljef::cli
