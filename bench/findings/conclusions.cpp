#include "bench/findings/conclusions.h"

namespace reljef::bench {

Findings all_findings() {
    return {findings_summary(),
            {relief_chapter(), parallax_chapter(), triangles_chapter(), objects_chapter(),
             search_chapter(), view_chapter(), light_chapter(), options_chapter(), data_chapter()},
            findings_limits()};
}

} // namespace reljef::bench
