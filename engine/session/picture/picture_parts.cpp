#include "engine/session/picture/picture_parts.h"

#include <algorithm>
#include <cmath>

#include "engine/io/image/picture_writer.h"
#include "engine/view/picture/eye_dome.h"

namespace reljef::session {
namespace {

constexpr double max_frame_pixels = 4096.0 * 4096.0;

static_assert(PictureParts::margin > view::max_eye_dome_reach);

constexpr int part_unit = 64; // two blocks of rays, the dither's repeat, and rows of a TIFF's tile
constexpr int max_part_side = 2048 - 2 * PictureParts::margin;

// The camera of the scene, as it was at the end.
class KeptCamera {
public:
    explicit KeptCamera(TerrainScene& scene)
        : camera_(*scene.camera->get<scene::Camera>()), whole_(camera_) {}
    KeptCamera(const KeptCamera&) = delete;
    KeptCamera& operator=(const KeptCamera&) = delete;
    ~KeptCamera() { camera_ = whole_; }

    void show(glm::ivec2 picture, const scene::PicturePart& part) {
        camera_ = scene::part_camera(whole_, picture, part);
    }

private:
    scene::Camera& camera_;
    scene::Camera whole_;
};

int count_of(int side, int part) {
    return (side + part - 1) / part;
}

// The middle of a frame.
void copy_part(const Image& frame, int first_col, Image& rows) {
    constexpr int margin = PictureParts::margin;
    const auto width =
        static_cast<std::size_t>(std::min(frame.cols() - 2 * margin, rows.cols() - first_col));
    for (int row = 0; row < rows.rows(); ++row) {
        const auto from = frame.row(margin + row).subspan(margin, width);
        std::copy(from.begin(), from.end(), rows.row(row).begin() + first_col);
    }
}

} // namespace

bool needs_parts(glm::ivec2 size) {
    return std::max(size.x, size.y) > max_frame_side ||
           static_cast<double>(size.x) * size.y > max_frame_pixels;
}

PictureParts parts_of(glm::ivec2 picture, int memory_megabytes) {
    // Bytes of a pixel of a row: its colour, and that of the encoder.
    constexpr double row_bytes = 2 * sizeof(Rgba8);
    // Of a frame: colours, and depths of four samples.
    constexpr double frame_bytes = 4 * 2 * sizeof(Rgba8);
    constexpr int margins = 2 * PictureParts::margin;
    const double half_of_memory = 1e6 * memory_megabytes / 8.0;
    const auto in_units = [](double pixels, int side) {
        const int whole = std::min(max_part_side, count_of(side, part_unit) * part_unit);
        const double fitting = std::clamp(pixels, double{part_unit}, static_cast<double>(whole));
        return static_cast<int>(fitting) / part_unit * part_unit;
    };
    const auto beside = [&](int side) {
        return half_of_memory / (frame_bytes * (side + margins)) - margins;
    };
    const double rows_in_memory = half_of_memory / (row_bytes * picture.x);
    const int rows = in_units(std::min(rows_in_memory, beside(part_unit)), picture.y);
    const double width = beside(rows);
    return {picture, {in_units(width, picture.x), rows}};
}

static void paint_over(const LargePicture& picture, Image& rows, int first_row) {
    if (picture.paint_over) {
        picture.paint_over(rows.view(), {0, first_row});
    }
}

Result<AtomicFile> draw_large_picture(const LargePicture& picture, TerrainScene& scene,
                                      FrameMaker& maker, const ParallelOptions& parallel) {
    const auto [whole, part] = picture.parts;
    auto writer = io::PictureWriter::create(picture.file, whole);
    if (!writer) {
        return writer.error();
    }
    maker.begin_parts(scene.scene, whole);
    KeptCamera camera(scene);
    const glm::ivec2 counts(count_of(whole.x, part.x), count_of(whole.y, part.y));
    const double parts = static_cast<double>(counts.x) * counts.y;
    double drawn_parts = 0.0;
    const ParallelOptions for_frames{parallel.threads, parallel.stop, {}};
    for (int first_row = 0; first_row < whole.y; first_row += part.y) {
        Image rows(whole.x, std::min(part.y, whole.y - first_row));
        for (int first_col = 0; first_col < whole.x; first_col += part.x) {
            const glm::ivec2 first = glm::ivec2(first_col, first_row) - PictureParts::margin;
            camera.show(whole, {first, picture.parts.frame()});
            const auto drawn = maker.draw(scene.scene, for_frames);
            if (!drawn) {
                return drawn.error();
            }
            if (parallel.stop.stop_requested()) { // while it was drawn
                return Error{"interrupted"};
            }
            copy_part(*drawn, first_col, rows);
            if (parallel.progress) {
                parallel.progress(++drawn_parts / parts);
            }
        }
        paint_over(picture, rows, first_row);
        if (auto written = writer->write(rows); !written) {
            return written.error();
        }
    }
    return writer->finish();
}

} // namespace reljef::session
