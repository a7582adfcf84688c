#include "engine/io/ascii_grid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>

namespace reljef::io {
namespace {

constexpr std::size_t bytes_at_a_time = std::size_t{1} << 20;
constexpr std::uint64_t most_header_words = 40;

struct FileCloser {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Counts the words of a text that comes in pieces; each name in its header has a value beside it.
class WordCount {
public:
    void add(std::string_view piece) {
        for (const char c : piece) {
            const bool in_word = !is_space(c);
            if (in_word && !in_word_) {
                ++words_;
                if (words_ <= most_header_words && begins_name(c)) {
                    ++names_;
                }
            }
            in_word_ = in_word;
        }
    }
    [[nodiscard]] std::uint64_t values() const { return words_ - std::min(words_, 2 * names_); }

private:
    std::uint64_t words_ = 0;
    std::uint64_t names_ = 0;
    bool in_word_ = false;
};

bool is_ascii_grid(GDALDataset& dataset) {
    constexpr std::array<std::string_view, 3> drivers{"AAIGrid", "GRASSASCIIGrid", "ISG"};
    const std::string_view driver = dataset.GetDriver()->GetDescription();
    return std::find(drivers.begin(), drivers.end(), driver) != drivers.end();
}

/// Stops where there are `enough`.
std::uint64_t count_values(const char* name, std::uint64_t enough) {
    const std::unique_ptr<VSILFILE, FileCloser> file(VSIFOpenL(name, "rb"));
    WordCount count;
    std::vector<char> piece(bytes_at_a_time);
    std::size_t read = file != nullptr ? piece.size() : 0;
    while (read == piece.size() && count.values() < enough) {
        read = VSIFReadL(piece.data(), 1, piece.size(), file.get());
        count.add({piece.data(), read});
    }
    return count.values();
}

} // namespace

Result<Dataset> open_whole_raster(const std::filesystem::path& path, const GdalMessages& messages) {
    auto dataset = open_raster(path, messages);
    if (!dataset || !is_ascii_grid(**dataset)) {
        return dataset;
    }
    const int cols = (*dataset)->GetRasterXSize();
    const int rows = (*dataset)->GetRasterYSize();
    const auto expected = static_cast<std::uint64_t>(cols) * static_cast<std::uint64_t>(rows);
    const std::uint64_t found = count_values((*dataset)->GetDescription(), expected);
    if (found < expected) {
        return Error{fmt::format("{}: cannot be read: {} values found, {}×{} were expected",
                                 path.string(), found, cols, rows)};
    }
    return dataset;
}

} // namespace reljef::io
