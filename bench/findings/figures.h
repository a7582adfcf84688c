#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/findings/conclusion.h"
#include "engine/scene/technique/technique.h"

namespace reljef::bench {

// Ranges.
Range at_least(double low);
Range at_most(double high);
Range between(double low, double high);

// Rows. Techniques name them by scene::to_string.
RowName source_test(const std::string& test, const scene::Technique& technique); ///< tables.json
struct View {
    std::string file;
    std::string scene;
    std::string pose;
};
RowName seen(const View& view, const scene::Technique& technique);
View bricks(); ///< a square with the gallery's bricks, oblique
/// `terrain`, "urban" or "natural", as high as `scale` of its width, "0.04" or "0.15"; scales.json.
View at_scale(const std::string& terrain, const std::string& scale);
/// A city from a distance.
struct CityView {
    std::string file; ///< "objects.json"
    std::string scene;
    int distance = 0; ///< metres
    int down = 15;    ///< degrees that the eye looks down
};
/// `form`: a name of building::city_form_names.
RowName city(const CityView& view, const std::string& form, const scene::Technique& technique);
/// A grazing view of `terrain`, "10 degrees" above the horizon, in angles.json.
RowName at_angle(const std::string& terrain, const std::string& angle,
                 const scene::Technique& technique);
/// Irrlicht's terrain node, still, pose overview, peers.json.
RowName irrlicht(int levels);
/// What does a work, "Embree, quads", from a pose, peers.json.
RowName peer(const std::string& work, const std::string& pose, const std::string& what);

// Figures.
Figure plain(const std::string& words, Quantity quantity, const RowName& row, const Range& range);
Figure ratio(const std::string& words, Quantity quantity, const RowName& row, const RowName& base,
             const Range& range);
/// Loss of frame rate against `base`, percent.
Figure drop(const std::string& words, const RowName& row, const RowName& base, const Range& range);
Figure frame_rate(const std::string& words, const RowName& row, const Range& range);
std::vector<Figure> joined(std::vector<Figure> figures, const std::vector<Figure>& more);
/// "error, city" instead of "city".
std::vector<Figure> named(const std::string& quantity, std::vector<Figure> figures);
std::vector<Conclusion> joined(std::vector<Conclusion> conclusions,
                               const std::vector<Conclusion>& more);
/// The same of a machine with a GPU. Precondition: their results exist in h100, too.
std::vector<Figure> on_gpu(std::vector<Figure> figures);
/// The figures, and then the same of a machine with a GPU.
std::vector<Figure> and_on_gpu(const std::vector<Figure>& figures);

/// Pixels over a city and a landscape that show points which nearer ground hides; of a file of
/// `tables --distances`.
std::vector<Figure> hidden_points(const std::string& file, const scene::Technique& technique,
                                  const Range& range);

/// The mean loss of frame rate of a technique in J's own table, percent.
struct ThesisDrop {
    double mean = 0.0;
    /// The most that the rounding of its frame rates to whole frames may move the mean.
    double rounding = 0.0;
    double lowest = 0.0; ///< of a single test
    double highest = 0.0;
};
/// `tests`: "relief-1" …; `machine`: 1 or 2, or both where both were measured. Precondition: all
/// are in the table.
ThesisDrop thesis_drop(const std::string& technique, const std::vector<std::string>& tests,
                       std::optional<int> machine = {});
Figure thesis_mean(const std::string& words, const ThesisDrop& drop, double text);

} // namespace reljef::bench
