// Indexes of errors: an input is a list of changes to a good one. Damage is found, never believed.
#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "engine/io/index/index_pass.h"
#include "engine/io/index/indexed_tile.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/made_dem.h"

namespace reljef::fuzz {
namespace {

constexpr int indexed_side = 150; // three levels, the last one stored

struct IndexStage {
    InputFolder folder;
    io::IndexSource source;
    std::string good;       // bytes of the index
    terrain::TileProof top; // of the whole terrain

    IndexStage() : source(make_source()) {
        const auto report = io::make_index(source, {.threads = 1});
        expect(report && report->errors.empty(), "an index");
        std::ifstream file(source.file, std::ios::binary);
        good = (std::ostringstream() << file.rdbuf()).str();
        const auto index = io::ErrorIndex::open(source);
        const auto found = index && *index ? (*index)->find(source.tree.root()) : std::nullopt;
        expect(found.has_value(), "a proof of the root");
        top = *found;
    }

private:
    io::IndexSource make_source() {
        const auto dem = folder.write("dem.asc", made_dem(indexed_side));
        auto tiles = io::TileSet::open(dem, {.threads = 1});
        expect(static_cast<bool>(tiles), "a terrain");
        const io::TileGrid grid = tiles->grid();
        auto made =
            io::index_source(std::move(*tiles), grid, io::Gaps::holes, folder.path() / "cache");
        expect(static_cast<bool>(made), "a source");
        return std::move(*made);
    }
};

// Changes: a length (one byte), a place (three bytes), as many bytes as the length says. A length
// of 255 cuts the file at the place.
std::string changed(std::string bytes, std::string_view changes) {
    while (changes.size() >= 4) {
        const auto length = static_cast<unsigned char>(changes[0]);
        std::size_t place = 0;
        std::memcpy(&place, changes.data() + 1, 3);
        changes.remove_prefix(4);
        place %= bytes.size() + 1;
        if (length == 255) {
            bytes.resize(place);
            continue;
        }
        const std::size_t count =
            std::min({std::size_t{length}, changes.size(), bytes.size() - place});
        std::copy_n(changes.begin(), count, bytes.begin() + static_cast<std::ptrdiff_t>(place));
        changes.remove_prefix(count);
    }
    return bytes;
}

} // namespace

void error_index_target(std::string_view input) {
    static const IndexStage stage;
    const std::string bytes = changed(stage.good, input);
    std::ofstream(stage.source.file, std::ios::binary | std::ios::trunc) << bytes;
    const auto index = io::ErrorIndex::open(stage.source);
    if (!index || !*index) {
        return;
    }
    expect(!(*index)->is_complete() ||
               (*index)->levels().size() ==
                   1 + static_cast<std::size_t>(stage.source.tree.root().level),
           "all levels");
    const auto found = (*index)->find(stage.source.tree.root());
    expect(!found || (found->low == stage.top.low && found->high == stage.top.high &&
                      found->error == stage.top.error),
           "the proof that was written, or none");
    const io::IndexedTiles tiles(stage.source, **index);
    for (int level = 0; level <= stage.source.tree.root().level; ++level) {
        static_cast<void>(tiles.read({level, 0, 0}));
        static_cast<void>(tiles.proof({level, 0, 0}));
    }
}

} // namespace reljef::fuzz
