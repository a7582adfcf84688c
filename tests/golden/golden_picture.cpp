#include "tests/golden/golden_picture.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "engine/io/image/image.h"

namespace reljef::test {
namespace {

constexpr int amplification = 8;

int channel_difference(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

Rgba8 amplified(Rgba8 a, Rgba8 b) {
    const auto strong = [](int difference) {
        return static_cast<std::uint8_t>(std::min(amplification * std::abs(difference), 255));
    };
    return {strong(a.r - b.r), strong(a.g - b.g), strong(a.b - b.b), 255};
}

Result<void> save_failure(const std::string& name, const Image& actual, const Image& difference,
                          const std::filesystem::path& folder) {
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (auto saved = io::write_image(folder / (name + ".actual.png"), actual); !saved) {
        return saved;
    }
    return difference.empty() ? Result<void>()
                              : io::write_image(folder / (name + ".difference.png"), difference);
}

Error failure(const std::string& name, const std::string& what, const Image& actual,
              const Image& difference, const GoldenFolders& folders) {
    const auto saved = save_failure(name, actual, difference, folders.failures);
    return {fmt::format("{}: {}; {}", name, what,
                        saved ? fmt::format("see {}/{}.*.png, and ./dev goldens where it is right",
                                            folders.failures.string(), name)
                              : saved.error().message)};
}

} // namespace

Result<GoldenDifference> golden_difference(const Image& actual, const Image& golden,
                                           const GoldenLimits& limits) {
    if (actual.cols() != golden.cols() || actual.rows() != golden.rows()) {
        return Error{fmt::format("is {}x{}, {}x{} was expected", actual.cols(), actual.rows(),
                                 golden.cols(), golden.rows())};
    }
    GoldenDifference result;
    result.picture = Image(actual.cols(), actual.rows());
    std::size_t failing = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const int difference = channel_difference(actual.samples()[i], golden.samples()[i]);
        failing += difference > limits.largest_difference ? 1U : 0U;
        result.largest_difference = std::max(result.largest_difference, difference);
        result.picture.samples()[i] = amplified(actual.samples()[i], golden.samples()[i]);
    }
    result.failing_fraction = static_cast<double>(failing) / static_cast<double>(actual.size());
    return result;
}

Result<void> check_golden(const std::string& name, const Image& actual,
                          const GoldenFolders& folders, const GoldenLimits& limits) {
    const auto golden = io::read_image(folders.pictures / (name + ".png"));
    if (!golden) {
        return failure(name, golden.error().message, actual, {}, folders);
    }
    const auto difference = golden_difference(actual, *golden, limits);
    if (!difference) {
        return failure(name, difference.error().message, actual, {}, folders);
    }
    if (difference->failing_fraction <= limits.failing_fraction) {
        return {};
    }
    return failure(name,
                   fmt::format("{:.3f} % of the pixels are more than {} of 255 off (at most {}), "
                               "{:.3f} % were expected",
                               100.0 * difference->failing_fraction, limits.largest_difference,
                               difference->largest_difference, 100.0 * limits.failing_fraction),
                   actual, difference->picture, folders);
}

} // namespace reljef::test
