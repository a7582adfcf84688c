#include "bench/findings/conclusions.h"

namespace reljef::bench {

std::vector<Chapter> findings_chapters() {
    return {relief_chapter(), parallax_chapter(), triangles_chapter(), search_chapter(),
            view_chapter(),   light_chapter(),    options_chapter(),   data_chapter()};
}

} // namespace reljef::bench
