#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>

#include "bench/runner/suite_options.h"
#include "engine/building/city_form.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/session/scene_setup.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/scene_caster.h"
#include "engine/truth/shading.h"

namespace reljef::bench {

/// A city to measure: `urban` of a size, or a scene file of bare ground with footprints.
struct CityChoice {
    std::string terrain = "urban";
    int size = 0; ///< of urban, samples; half a metre each
};

/// The same city as heights, as meshes on the bare ground, and as meshes on a level plane, seen by
/// the same camera.
class CityForms {
public:
    /// Fails without buildings. A scene file has no form meshes_only.
    static Result<CityForms> open(const CityChoice& choice, const SuiteOptions& options,
                                  const std::stop_token& stop);

    [[nodiscard]] const std::string& name() const { return name_; }
    /// How far a scanned surface model is from the city; absent: there is none.
    [[nodiscard]] const std::optional<std::string>& note() const { return note_; }
    [[nodiscard]] std::size_t buildings() const { return buildings_; }
    [[nodiscard]] bool has(building::CityForm form) const { return slot(form).has_value(); }
    /// Precondition: has(form).
    [[nodiscard]] const scene::Scene& scene(building::CityForm form) const {
        return slot(form)->scene;
    }
    void set_technique(building::CityForm form, const scene::Technique& technique);

    /// Looks north and `down` degrees down at the street level in the middle, from `distance`
    /// metres. Fails if the eye is not above the city.
    Result<void> look_from(double distance, double down);

    /// The errors of a form's picture against the true picture of the form meshes:
    /// - hit error, wrong surfaces and holes: how far the place that a pixel shows is from the
    ///   place that it should show, in samples of the heights; places on meshes count as well;
    /// - reprojection: of a terrain's texel by the heights of its own form. A mesh has no texels,
    ///   so its pixels have none.
    [[nodiscard]] Result<truth::GeometricErrors>
    errors(building::CityForm form, const HitBuffer& shown, const HitBuffer& truth) const;
    [[nodiscard]] Result<truth::Picture> draw_truth(const std::stop_token& stop);

private:
    CityForms(std::string name, const SuiteOptions& options)
        : name_(std::move(name)), options_(options) {}
    [[nodiscard]] const std::optional<session::TerrainScene>& slot(building::CityForm form) const {
        return forms_[static_cast<std::size_t>(form)];
    }
    std::optional<session::TerrainScene>& slot(building::CityForm form) {
        return forms_[static_cast<std::size_t>(form)];
    }
    [[nodiscard]] const scene::TerrainSurface& surface(building::CityForm form) const {
        return *slot(form)->terrain->get<scene::TerrainNode>()->surface;
    }
    [[nodiscard]] session::SourceOptions source_options() const;
    [[nodiscard]] Result<session::TerrainSource> open_source(io::SceneDescription description,
                                                             const std::stop_token& stop) const;
    Result<void> open_urban(int size, const std::stop_token& stop);
    Result<void> open_scene_file(const std::string& file, const std::stop_token& stop);
    Result<void> set_up(building::CityForm form, session::TerrainSource source,
                        const std::stop_token& stop);
    [[nodiscard]] HitBuffer on_terrain(const HitBuffer& hits) const;

    std::string name_;
    SuiteOptions options_;
    std::optional<std::string> note_;
    std::size_t buildings_ = 0;
    std::array<std::optional<session::TerrainScene>, 3> forms_; // by CityForm
    std::optional<truth::SceneCaster> caster_;                  // of the form meshes
    std::optional<truth::Shading> shading_;
};

} // namespace reljef::bench
