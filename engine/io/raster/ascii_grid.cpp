#include "engine/io/raster/ascii_grid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>

namespace reljef::io {
namespace {

constexpr std::size_t bytes_at_a_time = std::size_t{1} << 20;

bool is_nan(std::string_view word) {
    return word == "nan" || word == "NaN" || word == "NAN";
}

/// Whether a word cannot start a number.
bool is_name(std::string_view word) {
    const bool begins_with_letter =
        !word.empty() && ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z'));
    return begins_with_letter && !is_nan(word) && word != "inf" && word != "Inf";
}

/// Counts the words of a text in pieces, without its header of names with one value each.
class ValueCount {
public:
    void add(std::string_view piece) {
        for (const char c : piece) {
            if (std::string_view(" \n\r\t").find(c) == std::string_view::npos) {
                word_start_[std::min(length_, word_start_.size() - 1)] = c;
                ++length_;
            } else if (length_ > 0) {
                end_word();
            }
        }
    }
    /// Ends the last word.
    void finish() {
        if (length_ > 0) {
            end_word();
        }
    }
    [[nodiscard]] std::uint64_t values() const { return values_; }
    [[nodiscard]] bool has_nan() const { return has_nan_; }

private:
    void end_word() {
        const std::string_view word(word_start_.data(), std::min(length_, word_start_.size()));
        length_ = 0;
        if (in_header_ && std::exchange(value_follows_, false)) {
            return;
        }
        in_header_ = in_header_ && is_name(word);
        value_follows_ = in_header_;
        values_ += in_header_ ? 0 : 1;
        has_nan_ = has_nan_ || (!in_header_ && is_nan(word));
    }

    std::array<char, 8> word_start_{};
    std::size_t length_ = 0;
    bool in_header_ = true;
    bool value_follows_ = false;
    std::uint64_t values_ = 0;
    bool has_nan_ = false;
};

bool is_ascii_grid(GDALDataset& dataset) {
    constexpr std::array<std::string_view, 3> drivers{"AAIGrid", "GRASSASCIIGrid", "ISG"};
    const std::string_view driver = dataset.GetDriver()->GetDescription();
    return std::find(drivers.begin(), drivers.end(), driver) != drivers.end();
}

/// Stops at `enough` values.
ValueCount count_values(const char* name, std::uint64_t enough) {
    const std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file(VSIFOpenL(name, "rb"), &VSIFCloseL);
    ValueCount count;
    std::vector<char> piece(bytes_at_a_time);
    std::size_t read = file != nullptr ? piece.size() : 0;
    while (read == piece.size() && count.values() < enough) {
        read = VSIFReadL(piece.data(), 1, piece.size(), file.get());
        count.add({piece.data(), read});
    }
    count.finish();
    return count;
}

/// Whether some of the values are nan.
Result<bool> check_is_whole(GDALDataset& dataset, const std::filesystem::path& path) {
    const int cols = dataset.GetRasterXSize();
    const int rows = dataset.GetRasterYSize();
    const auto expected = static_cast<std::uint64_t>(cols) * static_cast<std::uint64_t>(rows);
    const ValueCount found = count_values(dataset.GetDescription(), expected);
    if (found.values() < expected) {
        return Error{fmt::format("{}: cannot be read: {} values found, {}×{} were expected",
                                 path.string(), found.values(), cols, rows)};
    }
    return found.has_nan();
}

} // namespace

Result<CheckedRaster> open_whole_raster(const std::filesystem::path& path,
                                        const GdalMessages& messages) {
    auto dataset = open_raster(path, messages);
    if (!dataset) {
        return dataset.error();
    }
    bool has_nan = false;
    if (is_ascii_grid(**dataset)) {
        const auto found = check_is_whole(**dataset, path);
        if (!found) {
            return found.error();
        }
        // GDAL guesses the type from the first values; whole numbers have no NaN.
        const GDALDataType type = (*dataset)->GetRasterBand(1)->GetRasterDataType();
        has_nan = *found && GDALDataTypeIsInteger(type) != 0;
    }
    std::optional<bool> mixed;
    if (has_nan) {
        dataset = open_with_floats(path, messages);
    } else {
        mixed = overviews_mix_voids(**dataset, path);
        if (mixed.value_or(false)) {
            dataset = open_without_overviews(path, messages);
        }
    }
    if (!dataset) {
        return dataset.error();
    }
    auto voids = undeclared_voids(**dataset, path);
    return CheckedRaster{std::move(*dataset), mixed, std::move(voids)};
}

Result<CheckedRaster> WholeRasters::open(const std::filesystem::path& path,
                                         const GdalMessages& messages) {
    std::error_code ignored;
    const auto changed = std::filesystem::last_write_time(path, ignored);
    Known known;
    {
        const std::lock_guard lock(mutex_);
        const auto found = whole_.find(path);
        if (found != whole_.end() && found->second.changed == changed) {
            known = found->second;
        }
    }
    if (known.mixed_overviews) {
        auto dataset = *known.mixed_overviews ? open_without_overviews(path, messages)
                                              : open_raster(path, messages);
        return dataset
                   ? Result<CheckedRaster>(CheckedRaster{std::move(*dataset), known.mixed_overviews,
                                                         std::move(known.undeclared_voids)})
                   : dataset.error();
    }
    auto raster = open_whole_raster(path, messages);
    if (raster) {
        const std::lock_guard lock(mutex_);
        whole_[path] = {changed, raster->mixed_overviews, raster->undeclared_voids};
    }
    return raster;
}

std::optional<std::vector<double>>
WholeRasters::undeclared_voids(const std::filesystem::path& path) const {
    const std::lock_guard lock(mutex_);
    const auto found = whole_.find(path);
    return found != whole_.end() ? found->second.undeclared_voids : std::nullopt;
}

} // namespace reljef::io
