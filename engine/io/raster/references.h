#pragma once

#include <string>

#include <gdal_priv.h>

#include "engine/core/result.h"

namespace reljef::io {

// What a raster file may refer to. A local file may lead GDAL only to files in or below its own
// folder, a member of an archive only to members in or below its own. Names that users type are
// not restricted in this way, but may use these virtual file systems of GDAL alone: /vsizip,
// /vsigzip, /vsitar and /vsicurl/. allow_external(true) lifts all this, and allows /vsis3, /vsigs
// and /vsiaz, which GDAL reads without deadlines and follows to any host.

/// Whether GDAL reads the name, which begins with "/vsi", from a server.
bool is_on_server(const std::string& name);

/// Fails if a name that a user typed uses another virtual file system, or holds '<': GDAL takes
/// such a name for the text of a file.
Result<void> check_typed_name(const std::string& name);

/// To call before GDAL opens `name`. Fails if it is a virtual raster that names anything outside
/// its folder, has a coordinate system that is no plain text, describes raw bytes, computes bands,
/// or reprojects a source of over max_block_bytes, or if a sidecar file is a link that leads
/// outside.
Result<void> check_references(const std::string& name);

/// To call when `dataset` is open, before anything else of it is read. Fails if its metadata names
/// a file outside its folder, or any file beside one on a server.
Result<void> check_named_files(GDALDataset& dataset);

/// As check_named_files, of the files that the dataset consists of.
Result<void> check_parts(GDALDataset& dataset);

} // namespace reljef::io
