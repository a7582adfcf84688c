#pragma once

#include "tests/architecture/source_rules.h"

namespace reljef::test {

/// Identifiers that hold a word of the project's old dialect: the field has another one.
Complaints dialect_names(const SourceFile& file);

/// Comments of a header, which are the API reference, with a phrase that must be read twice.
Complaints dialect_comments(const SourceFile& file);

} // namespace reljef::test
