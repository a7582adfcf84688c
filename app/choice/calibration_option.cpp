#include "app/choice/calibration_option.h"

#include <fmt/format.h>

#include "app/cli/program.h"
#include "app/cli/usage_error.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/calibration/calibration.h"

namespace reljef::app {

Result<std::optional<session::BackendKind>> context_to_use(const cli::ViewChoice& view) {
    using Context = std::optional<session::BackendKind>;
    if (view.context || view.calibration.empty()) {
        return view.context;
    }
    const auto calibration = session::read_calibration(view.calibration);
    return calibration ? Result<Context>(session::backend_from_string(calibration->place.context))
                       : calibration.error();
}

Result<void> use_calibration(const cli::ViewChoice& view, const platform::RendererInfo& info,
                             session::SceneRenderer& renderer) {
    if (view.calibration.empty()) {
        return {};
    }
    const scene::TechniqueId id = session::technique_of(view).id();
    if (id != scene::TechniqueId::automatic) {
        return usage_error(fmt::format("--calibration: technique {} found, auto was expected, "
                                       "which chooses by costs",
                                       scene::technique_info(id).name));
    }
    if (renderer.shows_rays()) {
        return usage_error(fmt::format(
            "--calibration: context {} found, where rays on the CPU draw whatever they can and "
            "nothing is chosen; --context osmesa or egl (in view: glfw) was expected",
            view.context == session::BackendKind::cpu ? "cpu" : "auto without a GPU"));
    }
    const auto costs =
        session::read_costs(view.calibration, session::place_of(info, cli::version_text()));
    if (!costs) {
        return costs.error();
    }
    renderer.set_costs(*costs);
    return {};
}

} // namespace reljef::app
