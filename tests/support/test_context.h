#pragma once

#include <string>

namespace reljef::test {

/// What tests draw with, as `--context` takes it: the environment variable RELJEF_TEST_CONTEXT,
/// else osmesa.
std::string context_name();

} // namespace reljef::test
