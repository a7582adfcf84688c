#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/color.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/comparing/error_figures.h"
#include "engine/session/frame_maker.h"
#include "engine/session/log.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

/// What is right of the line in a picture: the truth, unless something else is chosen.
struct CompareRequest {
    bool errors = false;                       ///< the error map of the left picture
    std::optional<scene::Technique> technique; ///< another technique
    double share = 0.5;                        ///< of the width left of the line, [0, 1]
};

/// The part right of the line: "truth", "errors" or a technique.
Result<CompareRequest> parse_compare_request(const std::string& text);

struct ComparedPicture {
    Image picture;                     ///< both parts
    std::vector<ErrorFigures> figures; ///< of the left picture, and of the other technique
};

/// Compares a frame that `maker` has drawn of the scene's view. Fails where there is no truth (in
/// scenes of models), if the other technique cannot draw the scene, and when stopped.
Result<ComparedPicture> compared_picture(TerrainScene& scene, FrameMaker& maker, const Image& left,
                                         const CompareRequest& request,
                                         const ParallelOptions& parallel, Log& log);

} // namespace reljef::session
