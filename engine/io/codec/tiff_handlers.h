#pragma once

#include <functional>

namespace reljef::io {

/// Calls a function that replaces libtiff's handlers of errors and warnings, and puts them back.
/// Meanwhile they get the messages of other threads all the same. Precondition: they are installed
/// for good.
void keep_tiff_handlers(const std::function<void()>& call);

} // namespace reljef::io
