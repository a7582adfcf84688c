#include "app/cli/manual.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "app/cli/parser.h"
#include "engine/core/atomic_file.h"

namespace reljef::cli {
namespace {

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
    return text;
}

// Escapes text for troff.
std::string roff(std::string_view text) {
    std::string escaped;
    for (const char letter : text) {
        const bool begins_line = escaped.empty() || escaped.back() == '\n';
        if (begins_line && (letter == '.' || letter == '\'')) {
            escaped += "\\&";
        }
        if (letter == '\\' || letter == '-') {
            escaped += '\\';
        }
        escaped += letter == '\\' ? 'e' : letter;
    }
    return escaped;
}

// A footer in troff. Indented lines stay as they are.
std::string roff_paragraphs(const std::string& text) {
    std::string page;
    bool is_verbatim = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const bool is_indented = line.starts_with("  ");
        if (is_indented != is_verbatim) {
            page += is_indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
            is_verbatim = is_indented;
        }
        page += roff(line) + "\n";
    }
    return page + (is_verbatim ? ".fi\n" : "");
}

std::string value_of(const CLI::Option& option) {
    return option.get_expected_max() == 0 ? "" : option.get_type_name();
}

std::string option_paragraph(const CLI::Option& option) {
    const std::string value = value_of(option);
    return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(option.get_name(false, true)),
                       value.empty() ? "" : " \\fI" + roff(value) + "\\fR",
                       roff(option.get_description()));
}

std::string page(const Program& program, const std::string& name, const std::string& synopsis,
                 const CLI::App& arguments, const std::string& sections) {
    std::string text =
        fmt::format(".TH {} 1 \"\" \"{}\" \"{} manual\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}\n",
                    upper(roff(name)), version_text(), program.name, roff(name),
                    roff(arguments.get_description()), synopsis);
    std::string options;
    for (const CLI::Option* const option : arguments.get_options()) {
        options += option_paragraph(*option);
    }
    text += ".SH OPTIONS\n" + options + sections;
    return text + ".SH NOTES\n" + roff_paragraphs(arguments.get_footer());
}

std::string program_page(const Program& program, const CLI::App& parser,
                         const std::vector<Command>& commands) {
    std::string verbs = fmt::format(".SH {}S\n", upper(program.verb));
    for (const Command& command : commands) {
        verbs += fmt::format(".TP\n\\fB{0}\\fR\n{1}; see \\fB{2}\\-{0}\\fR(1)\n",
                             roff(command.arguments->get_name()),
                             roff(command.arguments->get_description()), roff(program.name));
    }
    return page(program, program.name,
                fmt::format("\\fB{}\\fR \\fI{}\\fR [\\fIOPTIONS\\fR]", roff(program.name),
                            upper(program.verb)),
                parser, verbs);
}

std::string verb_page(const Program& program, const CLI::App& arguments) {
    std::string synopsis = fmt::format("\\fB{} {}\\fR [\\fIOPTIONS\\fR]", roff(program.name),
                                       roff(arguments.get_name()));
    for (const CLI::Option* const option : arguments.get_options()) {
        synopsis +=
            option->get_positional() ? fmt::format(" \\fI{}\\fR", roff(option->get_name())) : "";
    }
    return page(program, program.name + "-" + arguments.get_name(), synopsis, arguments,
                fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n", roff(program.name)));
}

std::vector<std::string> words_of(const CLI::App& arguments) {
    std::vector<std::string> words;
    for (const CLI::Option* const option : arguments.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            words.push_back("--" + name);
        }
        for (const std::string& name : option->get_snames()) {
            words.push_back("-" + name);
        }
    }
    return words;
}

std::string bash_completion(const Program& program, const CLI::App& parser,
                            const std::vector<Command>& commands) {
    std::vector<std::string> verbs{"help"};
    std::string cases;
    for (const Command& command : commands) {
        verbs.push_back(command.arguments->get_name());
        cases += fmt::format("    {}) words='{}' ;;\n", command.arguments->get_name(),
                             fmt::join(words_of(*command.arguments), " "));
    }
    std::string function = "_" + program.name;
    std::replace(function.begin(), function.end(), '-', '_');
    return fmt::format(R"(# bash completion for {0}
{1}() {{
    local words='{2} {3}'
    if ((COMP_CWORD > 1)); then
        case ${{COMP_WORDS[1]}} in
    help) words='{2}' ;;
{4}        esac
    fi
    if [[ ${{COMP_WORDS[COMP_CWORD]}} == -* || $COMP_CWORD -eq 1 || ${{COMP_WORDS[1]}} == help ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "${{COMP_WORDS[COMP_CWORD]}}")
    fi
}}
complete -o default -F {1} {0}
)",
                       program.name, function, fmt::join(verbs, " "),
                       fmt::join(words_of(parser), " "), cases);
}

// Escapes text within single quotes and [...] of _arguments.
std::string zsh_text(std::string_view text) {
    std::string escaped;
    for (const char letter : text) {
        if (letter == '\'') {
            escaped += "'\\'";
        } else if (letter == '[' || letter == ']' || letter == ':' || letter == '\\') {
            escaped += '\\';
        }
        escaped += letter == '\n' ? ' ' : letter;
    }
    return escaped;
}

std::string zsh_options(const CLI::App& arguments) {
    std::string lines;
    for (const CLI::Option* const option : arguments.get_options()) {
        if (option->get_lnames().empty()) {
            continue;
        }
        const std::string value = value_of(*option);
        lines += fmt::format("                '--{}[{}]{}' \\\n", option->get_lnames().front(),
                             zsh_text(option->get_description()),
                             value.empty() ? "" : ":" + zsh_text(value) + ":_files");
    }
    return lines;
}

std::string zsh_completion(const Program& program, const std::vector<Command>& commands) {
    std::string verbs;
    std::string cases;
    for (const Command& command : commands) {
        const CLI::App& arguments = *command.arguments;
        verbs += fmt::format("        '{}:{}'\n", arguments.get_name(),
                             zsh_text(arguments.get_description()));
        cases += fmt::format(
            "        {})\n            _arguments \\\n{}                '*:file:_files'\n"
            "            ;;\n",
            arguments.get_name(), zsh_options(arguments));
    }
    std::string function = "_" + program.name;
    return fmt::format(R"(#compdef {0}
{1}() {{
    local -a verbs
    verbs=(
{2}        'help:show the help of a verb'
    )
    if ((CURRENT == 2)); then
        _describe {3} verbs
        return
    fi
    local verb=$words[2]
    shift words
    ((CURRENT--))
    case $verb in
        help)
            _describe {3} verbs
            ;;
{4}    esac
}}
{1} "$@"
)",
                       program.name, function, verbs, program.verb, cases);
}

} // namespace

std::vector<ManualFile> manual_of(const Program& program) {
    Interrupt interrupt;
    const Parser parser(program, interrupt);
    std::vector<ManualFile> files{{fmt::format("man/man1/{}.1", program.name),
                                   program_page(program, parser.arguments(), parser.commands())},
                                  {fmt::format("bash-completion/completions/{}", program.name),
                                   bash_completion(program, parser.arguments(), parser.commands())},
                                  {fmt::format("zsh/site-functions/_{}", program.name),
                                   zsh_completion(program, parser.commands())}};
    for (const Command& command : parser.commands()) {
        files.push_back(
            {fmt::format("man/man1/{}-{}.1", program.name, command.arguments->get_name()),
             verb_page(program, *command.arguments)});
    }
    return files;
}

int write_manual(const Program& program, const std::string& folder) {
    for (const ManualFile& file : manual_of(program)) {
        const std::filesystem::path path = std::filesystem::path(folder) / file.path;
        std::error_code code;
        std::filesystem::create_directories(path.parent_path(), code);
        if (const auto written = write_file(path, std::as_bytes(std::span(file.text))); !written) {
            write_stderr(fmt::format("{}\n", written.error().message));
            return 1;
        }
    }
    return 0;
}

} // namespace reljef::cli
