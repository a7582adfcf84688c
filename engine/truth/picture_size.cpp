#include "engine/truth/picture_size.h"

#include <fmt/format.h>

namespace reljef::truth {

Result<void> check_same_size(const Image& shown, const Image& truth) {
    if (shown.cols() != truth.cols() || shown.rows() != truth.rows()) {
        return Error{fmt::format("a picture of {}x{} pixels: {}x{} as the true one was expected",
                                 shown.cols(), shown.rows(), truth.cols(), truth.rows())};
    }
    if (shown.empty()) {
        return Error{fmt::format("a picture of {}x{} pixels: one pixel at least was expected",
                                 shown.cols(), shown.rows())};
    }
    return {};
}

} // namespace reljef::truth
