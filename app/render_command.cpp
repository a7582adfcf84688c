#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/choice/calibration_option.h"
#include "app/choice/show_option.h"
#include "app/cli/console_log.h"
#include "app/cli/options.h"
#include "app/cli/output_files.h"
#include "app/cli/parsed_option.h"
#include "app/cli/shard_option.h"
#include "app/cli/standard_input.h"
#include "app/cli/usage_error.h"
#include "app/commands.h"
#include "app/objects/light_option.h"
#include "app/objects/object_option.h"
#include "app/objects/point_light_option.h"
#include "app/objects/surface_shader_option.h"
#include "app/rendering/draw_outputs.h"
#include "app/rendering/render_choice.h"
#include "engine/session/frame_maker.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::app {
namespace {

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

// A terrain that is seen whole is a block, and none of its ground is near. The exact picture shows
// no walls.
void set_usual_look(session::SceneOptions& view, const RenderChoice& choice, bool has_camera) {
    const bool is_map = session::is_map(view);
    const bool is_whole = !is_map && !has_camera && choice.view.path.empty();
    view.default_grain = is_map || is_whole ? 0.0 : 1.0;
    if (is_whole && !choice.truth && !choice.compare.request) {
        view.default_base = session::BaseKind::solid;
    }
}

// Keys of a scene file that options come before.
void add_keys_of_file(RenderChoice& choice, const io::SceneDescription& description) {
    choice.view.marks = choice.view.marks.value_or(description.marks);
    choice.view.samples = choice.view.samples ? choice.view.samples : description.samples;
}

Result<void> render(RenderChoice choice, const cli::Interrupt& interrupt) {
    interrupt.end_after(cli::Interrupt::longest_frame, "reljef: interrupted\n");
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
    add_keys_of_file(choice, *description);
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
    view.mesh_levels = choice.view.frames > 1;
    const bool has_camera = choice.view.eye || choice.view.geodetic || choice.view.pose;
    const bool has_camera_of_file = description->eye && !has_camera;
    set_usual_look(view, choice, has_camera || has_camera_of_file);
    auto scene =
        session::open_scene(std::move(*description), terrain, view, log, interrupt.token());
    if (!scene) {
        return scene.error();
    }
    scene->terrain->get<scene::TerrainNode>()->hides_overlay = choice.compare.request.has_value();
    auto drawn = draw_outputs({choice, *scene, *maker->frames, log, interrupt}, has_camera_of_file);
    if (!drawn) {
        return drawn;
    }
    session::log_stream_errors(scene->scene, log);
    return session::report_errors(choice.terrain.terrain,
                                  scene->failed_files + session::failed_files(scene->scene));
}

// Of a technique, the exact picture has the shadows only.
void check_truth(const cli::ViewChoice& view) {
    if (view.max_error.value_or(0.0) > 0.0) {
        throw CLI::ValidationError("--max-error: found beside --truth, which has no error; one "
                                   "of them was expected");
    }
    scene::Technique exact{scene::Exact{}};
    const bool is_exact = !view.technique || *view.technique == exact;
    exact.options.shadow = scene::Shadow{.depth = 0.0};
    if (!is_exact && *view.technique != exact) {
        cli::fail_usage(
            fmt::format("--technique: {} found beside --truth; exact or {} was expected",
                        scene::to_string(*view.technique), scene::to_string(exact)));
    }
}

void add_scene_options(CLI::App& arguments, RenderChoice& choice) {
    cli::add_terrain_options(arguments, choice.terrain);
    cli::add_view_options(arguments, choice.view);
    add_object_options(arguments, choice.view.objects, choice.view.footprints);
    add_light_option(arguments, choice.view.lights);
    add_point_light_option(arguments, choice.view.point_lights);
    add_surface_shader_option(arguments, choice.view.surface_shader);
    cli::add_samples_option(arguments, choice.view);
    cli::add_marks_option(arguments, choice.view);
    cli::add_index_option(arguments, choice.terrain, session::IndexUse::made);
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
    "  reljef render dem.tif --projection orthographic --size 2048x2048 --marks "
    "legend,scale,north -o map.png\n"
    "  reljef render N45E006.hgt --object house.glb:at=45.5,6.5 --hit hit.exr\n"
    "  reljef render urban --pose low --sun 0,-5 --point-light 3,-120:intensity=60 -o night.png\n"
    "  reljef render alps.tif --sun 265,12 --light 85,40:intensity=0.15,color=#88aaff -o dusk.png\n"
    "  reljef render urban --detail cobble:width=3 -o street.png\n"
    "  reljef render gallery --technique relief --textures cobble -o gallery.png\n"
    "  reljef render dem.tif --technique relief --compare errors -o errors.png\n"
    "  reljef render dem.tif --truth --rays 4 -o true.png --hit true.exr";

} // namespace

cli::Command add_render_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("render", "draw pictures without a window");
    auto choice = std::make_shared<RenderChoice>();
    add_scene_options(*arguments, *choice);
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
        "of a terrain larger than --memory; with --technique exact:shadow=hard, rays to the sun "
        "decide what is in shadow, of meshes, too");
    add_compare_option(*arguments, choice->compare);
    for (const char* option : {"--compare", "--wireframe", "--context", "--simd", "--shader-dir",
                               "--detail", "--samples", "--calibration", "--surface-shader"}) {
        truth->excludes(arguments->get_option(option));
    }
    cli::add_parsed(*arguments, "--rays", choice->rays, cli::number_in<int>("--rays", 1, 16),
                    "with --truth: N x N rays per pixel, 1 to 16 (1)", "N")
        ->needs(truth);
    cli::add_shard_option(*arguments, choice->shard, "frames of --path");
    arguments->add_flag("--resume", choice->resume,
                        "keep the numbered pictures of an earlier run of the same command; draw "
                        "those that are missing, damaged or of another size; .png, .jpg or .tif");
    add_show_option(*arguments, choice->shows_choice);
    arguments->get_option("--show")->excludes(arguments->get_option("--compare"));
    arguments->add_flag("--stats", choice->stats,
                        "print counts and times of the last frame (of a large picture: of all "
                        "parts), and times and memory of all frames");
    arguments->callback([choice] {
        cli::check_view_options(choice->view);
        expect_choice(choice->shows_choice, choice->view, choice->truth);
        if (choice->truth) {
            check_truth(choice->view);
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
