#include "bench/findings/findings_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "bench/findings/conclusions.h"
#include "bench/findings/distance_plot.h"
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
## How to read the tables

The numbers after D, M and J are chapters. A conclusion is

- **confirmed** if each figure keeps the rule in the column *confirmed if*,
- **refuted** if none does,
- **depends** if some do,
- **within noise** if none is outside, but the noise of the times leaves open whether all are inside,
- **answered** if the source asks or leaves a figure blank,
- **not measured yet** if a figure is missing.

Words such as "much" and "good" have no figure in the sources. Then the rule is our reading of them, and the column
says so. Three measures tell how wrong a picture is:

- *Wrong* is the share of the pixels of terrain that show a point more than one texel from the correct one. From afar a
  texel is smaller than a pixel. Then it also counts what nobody can see. *Hidden* is the share that shows a point which
  nearer ground hides, and *holes* are the share that shows no terrain.
- The error in pixels is the distance between where a point is shown and its true place (root mean square).
- *FLIP* is the difference from the true picture, as an eye sees it: 0 is none, 1 is all. The true picture has shadows,
  which most techniques do not draw. So even exact rays differ from it.

A number with × is a ratio. A time is as uncertain as the noise floor of its run (10 % if the run has none), or as the
interval of its median if that is wider; from 10 % on, it stands after ±.
*CPU* stands for a software renderer, *GPU* for a graphics card; without either word, it is a software renderer. The last
column names the results, with the command that measures them again, and the machine by a letter; both are listed below.
)";

constexpr std::string_view page_end = R"(
`reljef-bench findings --markdown docs/findings.md --plot docs/pictures/distance.svg` writes this page and its plot from
the results in `bench/results`. A test compares them.
)";

constexpr double shown_points = 10.0; // of the uncertainty of a percentage

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

bool has_gpu(const Figure& figure, const CommittedResults& results) {
    const auto machine = results.machine(figure.row.file);
    return machine && machine->has_gpu;
}

// Those of a CPU and of a GPU are lines of their own, if there are both.
std::string figures_text(const Conclusion& conclusion, const Judgement& judgement,
                         const CommittedResults& results) {
    std::vector<std::string> cpu;
    std::vector<std::string> gpu;
    for (std::size_t i = 0; i < conclusion.figures.size(); ++i) {
        const Figure& figure = conclusion.figures[i];
        (has_gpu(figure, results) ? gpu : cpu).push_back(figure_text(figure, judgement.numbers[i]));
    }
    std::string text = fmt::format("{}", fmt::join(cpu, "; "));
    if (!gpu.empty()) {
        text = fmt::format("{}{}GPU: {}", cpu.empty() ? "" : "CPU: " + text,
                           cpu.empty() ? "" : "<br>", fmt::join(gpu, "; "));
    }
    const char* const separator = text.empty() || conclusion.note.empty() ? "" : "; ";
    return text + separator + conclusion.note;
}

// Without the end of its file.
std::string name_of(const RowName& row) {
    return std::filesystem::path(row.file).replace_extension().generic_string();
}

// Of a heading on GitHub, without characters that are no letters, digits or hyphens.
std::string anchor_of(std::string name) {
    std::erase(name, '/');
    return name;
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
        const std::string name = name_of(figure.row);
        const auto machine = context.results.machine(figure.row.file);
        add(fmt::format("[{}](findings.md#{}){}", name, anchor_of(name),
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
    const bool holds =
        sentence.figures.empty() || verdict_of(sentence.figures, numbers) == Finding::confirmed;
    return holds ? fmt::vformat(sentence.text, texts) : std::string();
}

// The sentences that hold, each on a line that begins with `bullet`.
Result<std::string> sentences_text(std::span<const Chapter::Sentence> sentences,
                                   std::string_view bullet, const CommittedResults& results) {
    std::string text;
    for (const Chapter::Sentence& sentence : sentences) {
        const auto shown = sentence_text(sentence, results);
        if (!shown) {
            return shown.error();
        }
        text += shown->empty() ? "" : fmt::format("{}{}\n", bullet, *shown);
    }
    return text;
}

// Why a conclusion does not hold.
std::string reason_text(const Conclusion& conclusion, Finding verdict) {
    const bool holds =
        verdict != Finding::refuted && verdict != Finding::depends && verdict != Finding::open;
    return holds || conclusion.reason.empty()
               ? std::string()
               : fmt::format("- *{}* {}\n", conclusion.claim, conclusion.reason);
}

struct ChapterText {
    std::string text;
    std::vector<Finding> verdicts;
};

Result<ChapterText> chapter_text(const Chapter& chapter, const PageContext& context) {
    const auto answer = sentences_text(chapter.answer, "", context.results);
    if (!answer) {
        return answer.error();
    }
    ChapterText shown{fmt::format("\n## {}\n\n{}{}{}", chapter.question, *answer,
                                  answer->empty() ? "" : "\n", table_head),
                      {}};
    std::string reasons;
    for (const Conclusion& conclusion : chapter.conclusions) {
        const auto judgement = judge(conclusion, context.results);
        if (!judgement) {
            return judgement.error();
        }
        shown.verdicts.push_back(judgement->verdict);
        shown.text += fmt::format("| {} | {} | {} | {} | **{}** | {} |\n", conclusion.source,
                                  conclusion.claim, conclusion.rule.empty() ? "–" : conclusion.rule,
                                  figures_text(conclusion, *judgement, context.results),
                                  to_string(judgement->verdict), data_text(conclusion, context));
        reasons += reason_text(conclusion, judgement->verdict);
    }
    shown.text += reasons.empty() ? "" : "\nWhy some do not hold:\n\n" + reasons;
    return shown;
}

std::string counts_text(const std::vector<Finding>& verdicts) {
    const auto count = [&](Finding verdict) {
        return std::count(verdicts.begin(), verdicts.end(), verdict);
    };
    const auto missing = count(Finding::not_measured);
    return fmt::format(
        "\nOf {} conclusions, {} are confirmed, {} are refuted, and {} depend on the "
        "scene or the view;\n{} are within the noise of the times, and {} answer what a source "
        "leaves open{}.\n",
        verdicts.size(), count(Finding::confirmed), count(Finding::refuted),
        count(Finding::depends), count(Finding::open), count(Finding::answered),
        missing == 0 ? "" : fmt::format("; {} are not measured yet", missing));
}

std::string summary_text(const std::string& sentences, const CommittedResults& results) {
    if (sentences.empty()) {
        return sentences;
    }
    const std::string plot =
        results.has("distance.json")
            ? fmt::format("\n![Error and time over the distance of the eye from a city]({})\n",
                          distance_plot_file)
            : "";
    return "\n## In short\n\n" + sentences + plot;
}

std::string limits_text(const std::string& limits) {
    return limits.empty() ? limits : "\n## How far this holds\n\n" + limits;
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
    if (const std::size_t left_out = context.results.left_out(source.file()); left_out > 0) {
        text += fmt::format(" {} settings were left out, for want of time.", left_out);
    }
    text += source.quiet ? "" : " No time of it is used, because other work ran beside.";
    return text + fmt::format("\n\n```\nbuild/release/bin/{}\n```\n", source.command);
}

// From 10 % of the number on.
std::string uncertainty_text(const Number& number) {
    constexpr double shown_from = 0.1;
    const double share = number.uncertainty() / std::abs(number.value);
    return share >= shown_from ? fmt::format(" ± {:.0f}\u00a0%", 100.0 * share) : "";
}

} // namespace

std::string number_text(const Figure& figure, const Number& number) {
    const double value = number.value;
    switch (figure.form) {
    case Figure::Form::ratio:
        return fmt::format("{:.{}f}×{}", value, value >= 100.0 ? 0 : 2, uncertainty_text(number));
    case Figure::Form::drop:
        return fmt::format("{:.1f}{}\u00a0%", value,
                           number.uncertainty() >= shown_points
                               ? fmt::format(" ± {:.0f}", number.uncertainty())
                               : "");
    case Figure::Form::constant:
        return fmt::format("{:.1f}\u00a0%", value);
    case Figure::Form::rate:
        return fmt::format("{:.{}f}\u00a0a second", value, value < 100.0 ? 1 : 0);
    case Figure::Form::plain:
        break;
    }
    switch (figure.quantity) {
    case Quantity::ms:
        return fmt::format("{:.1f}\u00a0ms", value);
    case Quantity::wrong:
    case Quantity::hidden:
    case Quantity::holes:
    case Quantity::percent:
        return fmt::format("{:.1f}\u00a0%", value);
    case Quantity::error_px:
        return fmt::format("{:.{}f}\u00a0px", value, value >= 10.0 ? 1 : 2);
    case Quantity::flip:
    case Quantity::ssim:
        return fmt::format("{:.3f}", value);
    case Quantity::triangles:
    case Quantity::taps:
        return fmt::format("{:.1f}", value);
    case Quantity::bytes:
        return fmt::format("{:.1f}\u00a0MB", value / 1e6);
    }
    return {};
}

Result<std::string> findings_page(const Findings& findings, std::span<const ResultsSource> sources,
                                  const CommittedResults& results) {
    const PageContext context{sources, results, letters_of(sources, results)};
    const auto summary = sentences_text(findings.summary, "- ", results);
    if (!summary) {
        return summary.error();
    }
    std::vector<Finding> verdicts;
    std::string text;
    for (const Chapter& chapter : findings.chapters) {
        const auto shown = chapter_text(chapter, context);
        if (!shown) {
            return shown.error();
        }
        text += shown->text;
        verdicts.insert(verdicts.end(), shown->verdicts.begin(), shown->verdicts.end());
    }
    text = std::string(page_head) + summary_text(*summary, results) + counts_text(verdicts) +
           std::string(how_to_read) + text + limits_text(findings.limits) + machines_text(context);
    for (const ResultsSource& source : sources) {
        text += source_text(source, context);
    }
    return text + std::string(page_end);
}

Result<CommittedResults> read_all_results(const std::filesystem::path& folder) {
    const std::vector<ResultsSource> sources = results_sources();
    std::vector<std::string> files;
    std::transform(sources.begin(), sources.end(), std::back_inserter(files),
                   [](const ResultsSource& source) { return source.file(); });
    auto results = CommittedResults::read(folder, files);
    for (std::size_t i = 0; i < sources.size() && results; ++i) {
        const std::string suite = results->suite(sources[i].file());
        if (!suite.empty() && suite != sources[i].suite()) {
            return Error{fmt::format("{}: results of {} found, those of {} were expected",
                                     (folder / sources[i].file()).string(), cli::printable(suite),
                                     sources[i].suite())};
        }
    }
    return results;
}

Result<std::string> findings_page(const CommittedResults& results) {
    return findings_page(all_findings(), results_sources(), results);
}

} // namespace reljef::bench
