#include "app/rendering/draw_outputs.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/cli/lifted_frames.h"
#include "app/cli/progress_line.h"
#include "app/rendering/finished_frames.h"
#include "app/rendering/frame_sink.h"
#include "engine/io/image/image.h"
#include "engine/io/image/picture_writer.h"
#include "engine/session/flight_keys.h"
#include "engine/session/picture/faded_contours.h"
#include "engine/session/picture/scene_marks.h"
#include "engine/session/streaming.h"

namespace reljef::app {
namespace {

Result<void> add_output(Result<AtomicFile> prepared, std::vector<AtomicFile>& outputs) {
    if (!prepared) {
        return prepared.error();
    }
    outputs.push_back(std::move(*prepared));
    return {};
}

ParallelOptions frame_options(const Rendering& run, Progress progress = {}) {
    return {.threads = static_cast<unsigned>(run.choice.terrain.threads),
            .stop = run.interrupt.token(),
            .progress = std::move(progress)};
}

session::Underground underground(const RenderChoice& choice) {
    return choice.view.allow_underground ? session::Underground::allowed
                                         : session::Underground::lifted;
}

session::Lift fly(const Rendering& run, const scene::CameraPath& path, int index, int frames) {
    return session::fly_above_ground(run.scene, path, index, frames, run.maker,
                                     run.interrupt.token(), underground(run.choice));
}

// A frame that an earlier run drew, with --resume.
std::optional<Image> finished_frame(const RenderChoice& choice, int index) {
    const auto file = choice.resume ? numbered(choice.output, index) : Error{""};
    return file ? finished_picture(*file, choice.view.size) : std::nullopt;
}

void print_stats(const Rendering& run, int drawn) {
    if (run.choice.stats && drawn > 0) {
        fmt::print("{}", run.maker.stats());
    }
}

// A frame beside what --compare names.
Result<Image> compared_frame(const Rendering& run, const Image& frame) {
    session::CompareRequest request = *run.choice.compare.request;
    request.share = run.choice.compare.share;
    session::Log no_log;
    std::optional<cli::ProgressLine> line(std::in_place, "comparing", run.choice.terrain.quiet);
    auto compared = session::compared_picture(run.scene, run.maker, frame, request,
                                              frame_options(run, line->callback()), no_log);
    line.reset();
    if (!compared) {
        return compared.error();
    }
    print_figures(run.choice.compare, run.scene, compared->figures);
    return std::move(compared->picture);
}

// Notes on pictures, each once, with the number of the pictures if it is not true of all.
class PictureNotes {
public:
    void add(const std::string& sentence) { add(sentence, sentence); }
    // Of sentences on one subject, which differ in their numbers, the first one.
    void add(const std::string& subject, const std::string& sentence) {
        Note& note = notes_[subject];
        note.sentence = note.pictures++ == 0 ? sentence : note.sentence;
    }
    void pass_to(session::Log& log, int pictures) const {
        for (const auto& [subject, note] : notes_) {
            log.note(note.pictures == pictures
                         ? note.sentence
                         : fmt::format("{} ({} of {} pictures)", note.sentence, note.pictures,
                                       pictures));
        }
    }

private:
    struct Note {
        std::string sentence;
        int pictures = 0;
    };
    std::map<std::string, Note> notes_; // by subject
};

// Of the view that the scene's camera has.
void note_faded_contours(const Rendering& run, PictureNotes& notes) {
    const auto faded = session::faded_contours(run.scene, run.choice.view.size);
    if (faded && !run.choice.truth) {
        notes.add("contours", session::faded_text(
                                  *faded, run.scene.terrain->get<scene::TerrainNode>()->contours));
    }
}

// Of the view that the scene's camera has.
view::PictureMarks marks_of(const Rendering& run, PictureNotes& notes) {
    const auto chosen = run.choice.view.marks.value_or(io::MarksDescription());
    auto found = session::marks_of(run.scene, chosen, run.choice.view.size);
    for (const std::string& note : found.notes) {
        notes.add(note);
    }
    run.maker.keep_clear(view::mark_plates(found.marks, run.choice.view.size));
    return std::move(found.marks);
}

void draw_marks(const view::PictureMarks& marks, GridView<Rgba8> picture) {
    if (!marks.empty()) {
        view::draw_marks(marks, {picture.cols(), picture.rows()}, picture);
    }
}

// One frame, divided by --compare, with its marks. `progress` gets the part of it that is drawn.
Result<Image> draw_frame(const Rendering& run, PictureNotes& notes,
                         const std::function<void(double)>& progress) {
    run.maker.wait_for_tiles(run.scene.scene, run.interrupt.token()); // the marks need the ground
    const view::PictureMarks marks = marks_of(run, notes);
    auto picture = run.maker.draw(run.scene.scene, frame_options(run, progress));
    if (picture && run.choice.compare.request && !run.interrupt.requested()) {
        picture = compared_frame(run, *picture);
    }
    if (picture) {
        note_faded_contours(run, notes);
        draw_marks(marks, picture->view());
    }
    return run.interrupt.requested() ? Result<Image>(Error{"interrupted"}) : std::move(picture);
}

// Adds the files that are to be committed. Returns the frames whose cameras were lifted above the
// ground.
Result<cli::LiftedFrames> draw_frames(const Rendering& run,
                                      const std::optional<scene::CameraPath>& path,
                                      std::vector<AtomicFile>& outputs) {
    const RenderChoice& choice = run.choice;
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
    PictureNotes notes;
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
            lifted.add(fly(run, *path, index, frames));
        }
        auto picture = draw_frame(run, notes, [&](double part) {
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
    notes.pass_to(run.log, drawn);
    print_stats(run, drawn);
    const auto prepared = sheet.prepare(choice.contact_sheet, outputs);
    return prepared ? Result<cli::LiftedFrames>(lifted) : prepared.error();
}

// As draw_frames().
Result<void> draw_large(const Rendering& run, std::vector<AtomicFile>& outputs) {
    cli::ProgressLine line("drawing", run.choice.terrain.quiet);
    session::LargePicture picture{run.choice.output, parts_of(run.choice)};
    PictureNotes notes;
    const auto marks = marks_of(run, notes);
    note_faded_contours(run, notes);
    notes.pass_to(run.log, 1);
    if (!marks.empty()) {
        picture.paint_over = [marks, size = run.choice.view.size](GridView<Rgba8> rows,
                                                                  glm::ivec2 first) {
            view::draw_marks(marks, size, rows, first);
        };
    }
    auto drawn = session::draw_large_picture(picture, run.scene, run.maker,
                                             frame_options(run, line.callback()));
    print_stats(run, drawn ? 1 : 0);
    return add_output(std::move(drawn), outputs);
}

Result<HitBuffer> find_hits(const Rendering& run) {
    cli::ProgressLine line("finding hits", run.choice.terrain.quiet);
    auto hits = run.maker.draw_hits(run.scene.scene, frame_options(run, line.callback()));
    if (!hits || run.interrupt.requested()) {
        return hits ? Error{"interrupted"} : hits.error();
    }
    return session::in_source_rows(std::move(*hits), run.scene, run.choice.truth);
}

Result<void> prepare_found_hits(const Rendering& run, std::vector<AtomicFile>& outputs) {
    if (run.choice.hits.empty()) {
        return {};
    }
    const auto found = find_hits(run);
    return found ? add_output(io::prepare_hits(run.choice.hits, *found), outputs)
                 : Result<void>(found.error());
}

Result<std::optional<scene::CameraPath>> path_of(const Rendering& run) {
    using Path = std::optional<scene::CameraPath>;
    if (run.choice.view.path.empty()) {
        return Path();
    }
    auto path = session::open_path(run.scene, run.choice.view.path, run.log);
    return path ? Result<Path>(Path(std::move(*path))) : path.error();
}

} // namespace

Result<void> draw_outputs(const Rendering& run, bool has_camera_of_file) {
    const RenderChoice& choice = run.choice;
    const auto path = path_of(run);
    if (!path) {
        return path.error();
    }
    session::Lift lift;
    cli::LiftedFrames lifted;
    if (*path) {
        lifted.add(fly(run, **path, 0, 1));
    } else {
        lift = session::stand_above_ground(run.scene, run.maker, run.interrupt.token(),
                                           underground(choice));
    }
    std::vector<AtomicFile> outputs;
    if (auto prepared = prepare_found_hits(run, outputs); !prepared) {
        return prepared;
    }
    if (is_large(choice)) {
        if (auto drawn = draw_large(run, outputs); !drawn) {
            return drawn;
        }
    } else if (!choice.output.empty()) {
        auto drawn = draw_frames(run, *path, outputs);
        if (!drawn) {
            return drawn.error();
        }
        lifted = *drawn;
    }
    run.interrupt.end_after({}); // all files or none
    if (auto committed = commit_all(outputs); !committed) {
        return committed;
    }
    for (const std::string& note : run.maker.error_notes()) {
        run.log.note(note);
    }
    return *path ? lifted.report(run.log, choice.view.path)
                 : cli::report_lift(lift, cli::camera_source(choice.view, choice.terrain),
                                    has_camera_of_file, run.log);
}

} // namespace reljef::app
