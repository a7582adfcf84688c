#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "bench/baselines/baseline_view.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// A terrain as a height field of POV-Ray, in a temporary folder. Each picture is a process of its
/// own.
class PovrayScene {
public:
    /// Writes heights in 65536 steps, and colours. Fails if the folder cannot be written, and
    /// without POV-Ray (see draw_picture()).
    static Result<PovrayScene> create(const BaselineView& view);

    /// Draws the picture of colours without light. Returns the milliseconds of POV-Ray's "Trace
    /// Time": without its start and without reading the scene. Fails if POV-Ray is missing, fails
    /// or states no time.
    [[nodiscard]] Result<double> draw_picture(const BaselineView& view) const;

    /// The depths of the same picture along the view axis, metres, by rows from the top; infinity:
    /// no terrain. Fails as draw_picture().
    [[nodiscard]] Result<std::vector<double>> draw_depths(const BaselineView& view) const;

    /// Where the last picture is: picture.ppm.
    [[nodiscard]] const std::filesystem::path& folder() const;

private:
    struct Files; // removes the folder
    explicit PovrayScene(std::shared_ptr<const Files> files) : files_(std::move(files)) {}

    std::shared_ptr<const Files> files_;
};

} // namespace reljef::bench
