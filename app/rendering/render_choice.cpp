#include "app/rendering/render_choice.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "app/cli/usage_error.h"
#include "app/rendering/frame_sink.h"
#include "engine/io/image/image.h"
#include "engine/io/image/picture_writer.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {
namespace {

// Throws CLI::ParseError: parts of a flight are numbered pictures.
void expect_parts(const RenderChoice& choice) {
    const bool has_parts = !choice.shard.is_whole();
    const char* const option = has_parts ? "--shard" : "--resume";
    if (!has_parts && !choice.resume) {
        return;
    }
    if (!is_numbered(choice.output)) {
        cli::fail_usage(fmt::format("{}: '{}' found as -o, numbered pictures like %04d.png were "
                                    "expected; videos are made of them afterwards",
                                    option, choice.output.string()));
    }
    if (choice.resume && !io::shows_damage(choice.output)) {
        cli::fail_usage(fmt::format("--resume: '{}' found as -o, .png, .jpg or .tif pictures were "
                                    "expected, whose damage shows",
                                    choice.output.string()));
    }
    if (!choice.hits.empty() || (has_parts && !choice.contact_sheet.empty())) {
        cli::fail_usage(fmt::format("{}: found beside {}, only -o was expected", option,
                                    choice.hits.empty() ? "--contact-sheet" : "--hit"));
    }
}

// Throws CLI::ParseError for outputs and frames that do not go together.
void expect_fitting_outputs(const RenderChoice& choice) {
    if (choice.output.empty() && choice.hits.empty()) {
        cli::fail_usage("render: no output found, -o FILE or --hit FILE was expected");
    }
    if (choice.output.empty() &&
        (choice.stats || choice.compare.request || !choice.contact_sheet.empty())) {
        cli::fail_usage("render: --stats, --compare or --contact-sheet found without -o FILE, "
                        "whose frames they need");
    }
    if ((!choice.hits.empty() || choice.compare.request) && choice.view.frames > 1) {
        cli::fail_usage(fmt::format("render: {} found with many frames, one frame was expected",
                                    choice.hits.empty() ? "--compare" : "--hit"));
    }
    if (choice.view.frames > 1 && choice.view.path.empty()) {
        cli::fail_usage("render: --frames found without a --path to fly along");
    }
    if (const glm::ivec2 size = choice.view.size;
        std::max(size.x, size.y) > session::max_frame_side && !is_large(choice)) {
        cli::fail_usage(fmt::format("--size: {}x{} found; more than {} pixels a side need one .png "
                                    "or .tif picture alone",
                                    size.x, size.y, session::max_frame_side));
    }
}

} // namespace

bool is_large(const RenderChoice& choice) {
    return session::needs_parts(choice.view.size) && io::is_written_in_bands(choice.output) &&
           !is_numbered(choice.output) && choice.hits.empty() && choice.contact_sheet.empty() &&
           !choice.truth && !choice.compare.request;
}

session::PictureParts parts_of(const RenderChoice& choice) {
    return session::parts_of(choice.view.size, choice.terrain.memory_megabytes);
}

void expect_outputs(const RenderChoice& choice) {
    expect_fitting_outputs(choice);
    expect_parts(choice);
    const auto expect_good = [&](const Result<void>& named) {
        if (!named) {
            cli::fail_usage(named.error().message);
        }
    };
    if (is_standard_output(choice.output)) {
        expect_good(check_standard_output(choice.stats             ? "--stats"
                                          : choice.compare.request ? "--compare"
                                                                   : ""));
    }
    if (!choice.output.empty()) {
        expect_good(check_output_name(choice.output, choice.view.frames));
    }
    if (!choice.hits.empty()) {
        expect_good(io::check_hits_name(choice.hits));
    }
    if (!choice.contact_sheet.empty()) {
        expect_good(io::check_sheet_name(choice.contact_sheet));
    }
}

std::vector<cli::NamedFile> outputs_of(const RenderChoice& choice,
                                       std::span<const cli::NamedFile> inputs) {
    std::vector<cli::NamedFile> outputs{{"--hit", choice.hits},
                                        {"--contact-sheet", choice.contact_sheet}};
    if (is_standard_output(choice.output)) {
        return outputs;
    }
    if (!is_numbered(choice.output)) {
        outputs.push_back({"-o", choice.output});
        return outputs;
    }
    std::set<std::filesystem::path> names;
    for (const cli::NamedFile& file : inputs) {
        names.insert(file.path.filename());
    }
    names.insert({choice.hits.filename(), choice.contact_sheet.filename()});
    for (int index = 0; index < choice.view.frames; ++index) {
        const auto file = numbered(choice.output, index);
        if (file && (names.contains(file->filename()) || std::filesystem::exists(*file))) {
            outputs.push_back({"-o", *file});
        }
    }
    return outputs;
}

Result<void> check_targets(const RenderChoice& choice) {
    std::vector<cli::NamedFile> files{{"--hit", choice.hits},
                                      {"--contact-sheet", choice.contact_sheet}};
    if (!is_video(choice.output) && !is_numbered(choice.output) &&
        !is_standard_output(choice.output)) {
        files.push_back({"-o", choice.output});
    }
    return cli::check_writable(files);
}

} // namespace reljef::app
