#include "bench/report/environment_json.h"

namespace reljef::bench {

nlohmann::ordered_json environment_json(const Environment& environment) {
    return {{"renderer", environment.renderer}, {"gl", environment.gl},
            {"context", environment.context},   {"threads", environment.threads},
            {"cpu", environment.cpu},           {"commit", environment.commit}};
}

} // namespace reljef::bench
