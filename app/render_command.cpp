#include <algorithm>
#include <set>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/choice/calibration.h"
#include "app/choice/show_option.h"
#include "app/cli/console_log.h"
#include "app/cli/lifted_frames.h"
#include "app/cli/options.h"
#include "app/cli/output_files.h"
#include "app/cli/parsed_option.h"
#include "app/cli/progress_line.h"
#include "app/cli/shard_option.h"
#include "app/cli/standard_input.h"
#include "app/cli/usage_error.h"
#include "app/commands.h"
#include "app/comparing/compare_option.h"
#include "app/finished_frames.h"
#include "app/frame_sink.h"
#include "app/objects/object_option.h"
#include "engine/io/image/image.h"
#include "engine/io/image/picture_writer.h"
#include "engine/session/frame_maker.h"
#include "engine/session/picture/picture_parts.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::app {
namespace {

struct RenderChoice {
    cli::TerrainChoice terrain;
    cli::ViewChoice view;
    std::filesystem::path output;
    std::filesystem::path hits;
    std::filesystem::path contact_sheet;
    bool stats = false;
    bool shows_choice = false;
    bool truth = false;
    int rays = 1;
    Shard shard;
    bool resume = false;
    CompareChoice compare;
};

// One picture of many pixels, drawn in parts.
bool is_large(const RenderChoice& choice) {
    return session::needs_parts(choice.view.size) && io::is_written_in_bands(choice.output) &&
           !is_numbered(choice.output) && choice.hits.empty() && choice.contact_sheet.empty() &&
           !choice.truth && !choice.compare.request;
}

session::PictureParts parts_of(const RenderChoice& choice) {
    return session::parts_of(choice.view.size, choice.terrain.memory_megabytes);
}

// Draws frames, by rays on the CPU where it says so.
struct Maker {
    std::unique_ptr<session::FrameMaker> frames;
    session::RayUse rays = session::RayUse::none;
};

Result<Maker> make_frame_maker(const RenderChoice& choice, session::Log& log) {
    if (choice.truth) {
        return Maker{std::make_unique<session::TruthFrames>(choice.view.size, choice.rays, log)};
    }
    const auto context = context_to_use(choice.view);
    if (!context) {
        return context.error();
    }
    auto device = session::Device::create(
        {.context = *context,
         .prefers_rays = true,
         .size = is_large(choice) ? parts_of(choice).frame() : choice.view.size,
         .shader_dir = choice.view.shader_dir,
         .samples = choice.view.samples.value_or(view::automatic_samples),
         .threads = choice.terrain.threads,
         .simd = choice.view.simd});
    if (!device) {
        return device.error();
    }
    if (auto used = use_calibration(choice.view, device->info(), device->renderer()); !used) {
        return used.error();
    }
    const session::RayUse rays = device->rays();
    const session::DeviceFramesOptions options{choice.stats, choice.terrain.memory_megabytes, true,
                                               choice.shows_choice};
    return Maker{std::make_unique<session::DeviceFrames>(std::move(*device), log, options), rays};
}

Result<void> add_output(Result<AtomicFile> prepared, std::vector<AtomicFile>& outputs) {
    if (!prepared) {
        return prepared.error();
    }
    outputs.push_back(std::move(*prepared));
    return {};
}

ParallelOptions frame_options(const RenderChoice& choice, const cli::Interrupt& interrupt,
                              Progress progress = {}) {
    return {.threads = static_cast<unsigned>(choice.terrain.threads),
            .stop = interrupt.token(),
            .progress = std::move(progress)};
}

session::Underground underground(const RenderChoice& choice) {
    return choice.view.allow_underground ? session::Underground::allowed
                                         : session::Underground::lifted;
}

// A frame that an earlier run drew, with --resume.
std::optional<Image> finished_frame(const RenderChoice& choice, int index) {
    const auto file = choice.resume ? numbered(choice.output, index) : Error{""};
    return file ? finished_picture(*file, choice.view.size) : std::nullopt;
}

void print_stats(const RenderChoice& choice, const session::FrameMaker& maker, int drawn) {
    if (choice.stats && drawn > 0) {
        fmt::print("{}", maker.stats());
    }
}

// One frame, divided by --compare. `progress` gets the part of it that is drawn.
Result<Image> draw_frame(const RenderChoice& choice, session::TerrainScene& scene,
                         session::FrameMaker& maker, const cli::Interrupt& interrupt,
                         const std::function<void(double)>& progress) {
    auto picture = maker.draw(scene.scene, frame_options(choice, interrupt, progress));
    if (picture && !interrupt.requested()) {
        picture = compared_frame(choice.compare, scene, maker, std::move(*picture),
                                 frame_options(choice, interrupt));
    }
    return interrupt.requested() ? Result<Image>(Error{"interrupted"}) : std::move(picture);
}

// Adds the files that are to be committed. Returns the frames whose cameras were lifted above the
// ground.
Result<cli::LiftedFrames> draw_frames(const RenderChoice& choice, session::TerrainScene& scene,
                                      session::FrameMaker& maker,
                                      const std::optional<scene::CameraPath>& path,
                                      std::vector<AtomicFile>& outputs,
                                      const cli::Interrupt& interrupt) {
    const int frames = choice.view.frames;
    auto sink =
        make_frame_sink(choice.output, {.size = choice.view.size,
                                        .frames = frames,
                                        .frames_per_second = choice.view.frames_per_second});
    if (!sink) {
        return sink.error();
    }
    SheetPictures sheet(!choice.contact_sheet.empty(), frames);
    cli::LiftedFrames lifted;
    cli::ProgressLine line("drawing", choice.terrain.quiet);
    const std::vector<int> own = frames_of(choice.shard, frames);
    int drawn = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const int index = own[i];
        if (auto finished = finished_frame(choice, index)) {
            sheet.add(std::move(*finished), index);
            continue;
        }
        if (path) {
            lifted.add(session::fly_above_ground(scene, *path, index, frames, maker,
                                                 interrupt.token(), underground(choice)));
        }
        auto picture = draw_frame(choice, scene, maker, interrupt, [&](double part) {
            line.update((static_cast<double>(i) + part) / static_cast<double>(own.size()));
        });
        if (!picture) {
            return picture.error();
        }
        if (auto written = (*sink)->write(*picture, index); !written) {
            return written.error();
        }
        sheet.add(std::move(*picture), index);
        line.update(static_cast<double>(i + 1) / static_cast<double>(own.size()));
        ++drawn;
    }
    if (auto finished = (*sink)->finish(outputs); !finished) {
        return finished.error();
    }
    print_stats(choice, maker, drawn);
    const auto prepared = sheet.prepare(choice.contact_sheet, outputs);
    return prepared ? Result<cli::LiftedFrames>(lifted) : prepared.error();
}

// As draw_frames().
Result<void> draw_large(const RenderChoice& choice, session::TerrainScene& scene,
                        session::FrameMaker& maker, std::vector<AtomicFile>& outputs,
                        const cli::Interrupt& interrupt) {
    cli::ProgressLine line("drawing", choice.terrain.quiet);
    auto drawn = session::draw_large_picture({choice.output, parts_of(choice)}, scene, maker,
                                             frame_options(choice, interrupt, line.callback()));
    print_stats(choice, maker, drawn ? 1 : 0);
    return add_output(std::move(drawn), outputs);
}

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

// Throws CLI::ParseError for wrong or contradicting outputs.
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
        expect_good(io::check_image_name(choice.contact_sheet));
    }
}

// The files that will be written. Numbered pictures are included if they exist or have an input's
// name.
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

// Checks before long work that the outputs can be written.
Result<void> check_targets(const RenderChoice& choice) {
    std::vector<cli::NamedFile> files{{"--hit", choice.hits},
                                      {"--contact-sheet", choice.contact_sheet}};
    if (!is_video(choice.output) && !is_numbered(choice.output) &&
        !is_standard_output(choice.output)) {
        files.push_back({"-o", choice.output});
    }
    return cli::check_writable(files);
}

Result<HitBuffer> find_hits(const RenderChoice& choice, const session::TerrainScene& scene,
                            session::FrameMaker& maker, const cli::Interrupt& interrupt) {
    cli::ProgressLine line("finding hits", choice.terrain.quiet);
    auto hits = maker.draw_hits(scene.scene, frame_options(choice, interrupt, line.callback()));
    if (!hits || interrupt.requested()) {
        return hits ? Error{"interrupted"} : hits.error();
    }
    return session::in_source_rows(std::move(*hits), scene, choice.truth);
}

Result<std::optional<scene::CameraPath>> path_of(const session::TerrainScene& scene,
                                                 const RenderChoice& choice, session::Log& log) {
    using Path = std::optional<scene::CameraPath>;
    if (choice.view.path.empty()) {
        return Path();
    }
    auto path = session::open_path(scene, choice.view.path, log);
    return path ? Result<Path>(Path(std::move(*path))) : path.error();
}

Result<void> prepare_found_hits(const RenderChoice& choice, session::TerrainScene& scene,
                                session::FrameMaker& maker, std::vector<AtomicFile>& outputs,
                                const cli::Interrupt& interrupt) {
    if (choice.hits.empty()) {
        return {};
    }
    const auto found = find_hits(choice, scene, maker, interrupt);
    return found ? add_output(io::prepare_hits(choice.hits, *found), outputs)
                 : Result<void>(found.error());
}

Result<void> draw_outputs(const RenderChoice& choice, session::TerrainScene& scene,
                          bool has_camera_of_file, session::FrameMaker& maker, session::Log& log,
                          const cli::Interrupt& interrupt) {
    const auto path = path_of(scene, choice, log);
    if (!path) {
        return path.error();
    }
    session::Lift lift;
    cli::LiftedFrames lifted;
    if (*path) {
        lifted.add(session::fly_above_ground(scene, **path, 0, 1, maker, interrupt.token(),
                                             underground(choice)));
    } else {
        lift = session::stand_above_ground(scene, maker, interrupt.token(), underground(choice));
    }
    std::vector<AtomicFile> outputs;
    if (auto prepared = prepare_found_hits(choice, scene, maker, outputs, interrupt); !prepared) {
        return prepared;
    }
    if (is_large(choice)) {
        if (auto drawn = draw_large(choice, scene, maker, outputs, interrupt); !drawn) {
            return drawn;
        }
    } else if (!choice.output.empty()) {
        auto drawn = draw_frames(choice, scene, maker, *path, outputs, interrupt);
        if (!drawn) {
            return drawn.error();
        }
        lifted = *drawn;
    }
    if (auto committed = commit_all(outputs); !committed) {
        return committed;
    }
    for (const std::string& note : maker.error_notes()) {
        log.note(note);
    }
    return *path ? lifted.report(log, choice.view.path)
                 : cli::report_lift(lift, cli::camera_source(choice.view, choice.terrain),
                                    has_camera_of_file, log);
}

Result<void> render(const RenderChoice& choice, const cli::Interrupt& interrupt) {
    if (auto good = check_targets(choice); !good) {
        return good;
    }
    cli::ConsoleLog log(choice.terrain.quiet);
    auto description = session::describe(choice.terrain.terrain);
    if (!description) {
        return description.error();
    }
    if ((choice.truth || choice.compare.request) && description->generator == "gallery") {
        return usage_error(fmt::format("{}: {} found, which has no exact picture; a "
                                       "terrain was expected, or --technique exact",
                                       choice.truth ? "--truth" : "--compare",
                                       choice.terrain.terrain));
    }
    auto inputs = cli::input_files(choice.terrain, choice.view);
    for (const auto& [what, file] : io::named_files(*description)) {
        inputs.push_back({what, file});
    }
    cli::check_distinct(outputs_of(choice, inputs), inputs);
    auto maker = make_frame_maker(choice, log);
    if (!maker) {
        return maker.error();
    }
    session::SourceOptions terrain = choice.terrain;
    terrain.streamed = true;
    terrain.index = choice.truth ? session::IndexUse::none : terrain.index;
    session::SceneOptions view = choice.view;
    view.rays = maker->rays;
    view.prepares_maps = !choice.truth;
    const bool has_camera_of_file =
        description->eye && !choice.view.eye && !choice.view.geodetic && !choice.view.pose;
    auto scene =
        session::open_scene(std::move(*description), terrain, view, log, interrupt.token());
    if (!scene) {
        return scene.error();
    }
    auto drawn = draw_outputs(choice, *scene, has_camera_of_file, *maker->frames, log, interrupt);
    if (!drawn) {
        return drawn;
    }
    session::log_stream_errors(scene->scene, log);
    return session::report_errors(choice.terrain.terrain,
                                  scene->failed_files + session::failed_files(scene->scene));
}

constexpr const char* examples =
    "Examples:\n"
    "  reljef render N45E006.hgt -o alps.png\n"
    "  reljef render N45E006.hgt --camera 45.7,6.8,4000,20,-15 -o mont-blanc.png\n"
    "  reljef render urban --path orbit --frames 48 -o 'frames/%04d.png' --contact-sheet "
    "sheet.png\n"
    "  reljef render natural --path flyover --frames 250 -o flight.mp4\n"
    "  reljef render alps.tif --path flight.toml --frames 9000 -o 'frames/%04d.png' --shard "
    "slurm --resume\n"
    "  reljef render dem.tif --projection orthographic --size 2048x2048 -o map.png\n"
    "  reljef render N45E006.hgt --object house.glb:at=45.5,6.5 --hit hit.exr\n"
    "  reljef render urban --detail cobble:width=3 -o street.png\n"
    "  reljef render gallery --technique relief --textures cobble -o gallery.png\n"
    "  reljef render dem.tif --technique relief --compare errors -o errors.png\n"
    "  reljef render dem.tif --truth --rays 4 -o true.png --hit true.exr";

} // namespace

cli::Command add_render_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("render", "draw pictures without a window");
    auto choice = std::make_shared<RenderChoice>();
    cli::add_terrain_options(*arguments, choice->terrain);
    cli::add_view_options(*arguments, choice->view);
    add_object_option(*arguments, choice->view.objects);
    cli::add_samples_option(*arguments, choice->view);
    cli::add_index_option(*arguments, choice->terrain, session::IndexUse::made);
    arguments
        ->add_option("-o,--output", choice->output,
                     "picture (out.png; - for PNG to standard output), numbered pictures "
                     "('frames/%04d.png') or video (flight.mp4)")
        ->type_name("FILE");
    arguments
        ->add_option("--hit", choice->hits,
                     "OpenEXR file with the hit of each pixel: col, row, height, depth, and "
                     "col_low, row_low to add to col, row")
        ->type_name("FILE");
    arguments
        ->add_option("--contact-sheet", choice->contact_sheet,
                     "picture with small copies of up to 24 frames")
        ->type_name("FILE");
    auto* truth = arguments->add_flag(
        "--truth", choice->truth,
        "draw the reference picture with exact rays on the CPU, of all samples, also "
        "of a terrain larger than --memory");
    add_compare_option(*arguments, choice->compare);
    for (const char* option : {"--compare", "--wireframe", "--context", "--simd", "--technique",
                               "--shader-dir", "--detail", "--samples", "--calibration"}) {
        truth->excludes(arguments->get_option(option));
    }
    cli::add_parsed(*arguments, "--rays", choice->rays, cli::number_in<int>("--rays", 1, 16),
                    "with --truth: N x N rays per pixel, 1 to 16 (1)", "N")
        ->needs(truth);
    cli::add_shard_option(*arguments, choice->shard, "frames of --path");
    arguments->add_flag("--resume", choice->resume,
                        "keep the numbered pictures of an earlier run of the same command; draw "
                        "those that are missing, of another size, or cannot be read");
    add_show_option(*arguments, choice->shows_choice);
    arguments->add_flag("--stats", choice->stats,
                        "print counts and times of the last frame (of a large picture: of all "
                        "parts), and times and memory of all frames");
    arguments->callback([choice] {
        cli::check_view_options(choice->view);
        expect_choice(choice->shows_choice, choice->view, choice->truth);
        if (choice->truth && choice->view.max_error.value_or(0.0) > 0.0) {
            throw CLI::ValidationError("--max-error: found beside --truth, which has no error; one "
                                       "of them was expected");
        }
        expect_outputs(*choice);
    });
    arguments->footer(examples);
    return {arguments, [choice, &interrupt] {
                return cli::with_standard_input(choice->terrain.terrain, interrupt.token(),
                                                [&] { return render(*choice, interrupt); });
            }};
}

} // namespace reljef::app
