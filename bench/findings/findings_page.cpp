#include "bench/findings/findings_page.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/judgement.h"

namespace reljef::bench {
namespace {

constexpr std::string_view page_head = R"(# Do the conclusions of the sources hold?

reljef grew from three works:

- **D**: Carsten Dachsbacher, *Parallax Bump Mapping*, a workshop in a German magazine.
- **M**: Tamás Mile, *Shader nyelvek lehetőségei* (what shader languages can do), thesis, Debrecen 2008.
- **J**: Danijel Janković, *Reljefne tehnike teksturiranja u prikazu terena* (relief texturing in the display of
  terrain), thesis, Zagreb 2010.

They judge by eye and by frame rate. reljef also measures how wrong each pixel is. This page compares each of their
conclusions with what reljef measures. Left out are predictions, and how easy something is to program.
)";

constexpr std::string_view how_to_read = R"(
The numbers after D, M and J are chapters. A conclusion is

- **confirmed** if each figure keeps the rule in the column *confirmed if*,
- **refuted** if none does,
- **depends** if some do, or if the noise of the times leaves open whether they do,
- **answered** if the source asks or leaves a figure blank,
- **not measured yet** if a figure is missing.

Words such as "much" and "good" have no figure in the sources. Then the rule is our reading of them, and the column
says so. *Wrong* is the share of pixels that show a point more than one texel from the correct one. The error in pixels
is the distance between where a point is shown and its true place (root mean square). A number with × is a ratio. Times
are as uncertain as the noise floor of their run, or by 10 % if the run has none. The last column names the results, with the
command that measures them again, and the machine by a letter; both are listed below.
)";

constexpr std::string_view page_end = R"(
`reljef-bench findings --markdown docs/findings.md` writes this page from the results in `bench/results`. A test
compares both.
)";

constexpr std::string_view table_head =
    "| source | conclusion | confirmed if | reljef measures | verdict | data |\n"
    "|:--|:--|:--|:--|:--|:--|\n";

std::string name_of(const Machine& machine) {
    return fmt::format("{}, {} thread{}, {}", machine.cpu, machine.threads,
                       machine.threads == 1 ? "" : "s", machine.renderer);
}

// A letter for each machine, in the order of the sources.
std::map<std::string, char> letters_of(std::span<const ResultsSource> sources,
                                       const CommittedResults& results) {
    std::map<std::string, char> letters;
    for (const ResultsSource& source : sources) {
        if (const auto machine = results.machine(source.file())) {
            letters.try_emplace(name_of(*machine), static_cast<char>('A' + letters.size()));
        }
    }
    return letters;
}

struct PageContext {
    std::span<const ResultsSource> sources;
    const CommittedResults& results;
    std::map<std::string, char> letters;
};

std::string figure_text(const Figure& figure, const std::optional<Number>& number) {
    const std::string text = number ? number_text(figure, *number) : "–";
    return figure.words.empty() ? text : fmt::format("{}: {}", figure.words, text);
}

std::string figures_text(const Conclusion& conclusion, const Judgement& judgement) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < conclusion.figures.size(); ++i) {
        texts.push_back(figure_text(conclusion.figures[i], judgement.numbers[i]));
    }
    std::string text = fmt::format("{}", fmt::join(texts, "; "));
    const char* const separator = text.empty() || conclusion.note.empty() ? "" : "; ";
    return text + separator + conclusion.note;
}

// The results files of a conclusion, with the letter of the machine.
std::string data_text(const Conclusion& conclusion, const PageContext& context) {
    std::vector<std::string> texts;
    const auto add = [&](const std::string& text) {
        if (std::find(texts.begin(), texts.end(), text) == texts.end()) {
            texts.push_back(text);
        }
    };
    for (const Figure& figure : conclusion.figures) {
        if (figure.form == Figure::Form::constant) {
            add("J's table");
            continue;
        }
        const std::string name = std::filesystem::path(figure.row.file).stem().string();
        const auto machine = context.results.machine(figure.row.file);
        add(fmt::format("[{0}](findings.md#{0}){1}", name,
                        machine ? fmt::format(", {}", context.letters.at(name_of(*machine))) : ""));
    }
    return texts.empty() ? "–" : fmt::format("{}", fmt::join(texts, "; "));
}

Result<std::string> sentence_text(const Chapter::Sentence& sentence,
                                  const CommittedResults& results) {
    std::vector<std::optional<Number>> numbers;
    fmt::dynamic_format_arg_store<fmt::format_context> texts;
    for (const Figure& figure : sentence.figures) {
        const auto number = number_of(figure, results);
        if (!number) {
            return number.error();
        }
        numbers.push_back(*number);
        texts.push_back(*number ? number_text(figure, **number) : "");
    }
    return verdict_of(sentence.figures, numbers) == Finding::confirmed
               ? fmt::vformat(sentence.text, texts)
               : std::string();
}

// The sentences that hold, one a line; empty if none does.
Result<std::string> answer_text(const Chapter& chapter, const CommittedResults& results) {
    std::string text;
    for (const Chapter::Sentence& sentence : chapter.answer) {
        const auto shown = sentence_text(sentence, results);
        if (!shown) {
            return shown.error();
        }
        text += shown->empty() ? "" : *shown + "\n";
    }
    return text.empty() ? text : text + "\n";
}

struct ChapterText {
    std::string text;
    std::vector<Finding> verdicts;
};

Result<ChapterText> chapter_text(const Chapter& chapter, const PageContext& context) {
    const auto answer = answer_text(chapter, context.results);
    if (!answer) {
        return answer.error();
    }
    ChapterText shown{fmt::format("\n## {}\n\n{}{}", chapter.question, *answer, table_head), {}};
    for (const Conclusion& conclusion : chapter.conclusions) {
        const auto judgement = judge(conclusion, context.results);
        if (!judgement) {
            return judgement.error();
        }
        shown.verdicts.push_back(judgement->verdict);
        shown.text += fmt::format("| {} | {} | {} | {} | **{}** | {} |\n", conclusion.source,
                                  conclusion.claim, conclusion.rule.empty() ? "–" : conclusion.rule,
                                  figures_text(conclusion, *judgement),
                                  to_string(judgement->verdict), data_text(conclusion, context));
    }
    return shown;
}

std::string counts_text(const std::vector<Finding>& verdicts) {
    const auto count = [&](Finding verdict) {
        return std::count(verdicts.begin(), verdicts.end(), verdict);
    };
    const auto missing = count(Finding::not_measured);
    return fmt::format(
        "\nOf {} conclusions, {} are confirmed, {} are refuted, and {} depend on the "
        "scene or the view;\n{} answer what a source leaves open{}.\n",
        verdicts.size(), count(Finding::confirmed), count(Finding::refuted),
        count(Finding::depends), count(Finding::answered),
        missing == 0 ? "" : fmt::format(", and {} are not measured yet", missing));
}

std::string machines_text(const PageContext& context) {
    std::map<char, std::string> machines;
    for (const auto& [name, letter] : context.letters) {
        machines.emplace(letter, name);
    }
    std::string text = "\n## The measurements\n\nMachines:\n\n";
    for (const auto& [letter, name] : machines) {
        text += fmt::format("- {}: {}\n", letter, name);
    }
    return machines.empty() ? "\n## The measurements\n" : text;
}

std::string source_text(const ResultsSource& source, const PageContext& context) {
    std::string text = fmt::format("\n### {}\n\n{}", source.name, source.what);
    const auto machine = context.results.machine(source.file());
    if (!context.results.has(source.file())) {
        text += " Not measured yet.";
    } else if (machine) {
        text += fmt::format(" Machine {}, commit {}.", context.letters.at(name_of(*machine)),
                            machine->commit);
    }
    text += source.quiet ? "" : " No time of it is used, because other work ran beside.";
    return text + fmt::format("\n\n```\nbuild/release/bin/{}\n```\n", source.command);
}

} // namespace

std::string number_text(const Figure& figure, const Number& number) {
    const double value = number.value;
    switch (figure.form) {
    case Figure::Form::ratio:
        return value >= 100.0 ? fmt::format("{:.0f}×", value) : fmt::format("{:.2f}×", value);
    case Figure::Form::drop:
    case Figure::Form::constant:
        return fmt::format("{:.1f}\u00a0%", value);
    case Figure::Form::rate:
        return fmt::format("{:.1f}\u00a0per second", value);
    case Figure::Form::plain:
        break;
    }
    switch (figure.quantity) {
    case Quantity::ms:
        return fmt::format("{:.1f}\u00a0ms", value);
    case Quantity::wrong:
    case Quantity::percent:
        return fmt::format("{:.1f}\u00a0%", value);
    case Quantity::error_px:
        return fmt::format("{:.{}f}\u00a0px", value, value >= 10.0 ? 1 : 2);
    case Quantity::flip:
        return fmt::format("{:.3f}", value);
    case Quantity::triangles:
    case Quantity::taps:
        return fmt::format("{:.1f}", value);
    case Quantity::bytes:
        return fmt::format("{:.1f}\u00a0MB", value / 1e6);
    }
    return {};
}

Result<std::string> findings_page(std::span<const Chapter> chapters,
                                  std::span<const ResultsSource> sources,
                                  const CommittedResults& results) {
    const PageContext context{sources, results, letters_of(sources, results)};
    std::vector<Finding> verdicts;
    std::string text;
    for (const Chapter& chapter : chapters) {
        const auto shown = chapter_text(chapter, context);
        if (!shown) {
            return shown.error();
        }
        text += shown->text;
        verdicts.insert(verdicts.end(), shown->verdicts.begin(), shown->verdicts.end());
    }
    text = std::string(page_head) + counts_text(verdicts) + std::string(how_to_read) + text;
    text += machines_text(context);
    for (const ResultsSource& source : sources) {
        text += source_text(source, context);
    }
    return text + std::string(page_end);
}

Result<std::string> findings_page(const std::filesystem::path& folder) {
    const std::vector<ResultsSource> sources = results_sources();
    std::vector<std::string> files;
    std::transform(sources.begin(), sources.end(), std::back_inserter(files),
                   [](const ResultsSource& source) { return source.file(); });
    const auto results = CommittedResults::read(folder, files);
    if (!results) {
        return results.error();
    }
    return findings_page(findings_chapters(), sources, *results);
}

} // namespace reljef::bench
