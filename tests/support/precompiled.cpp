// The tests reuse the precompiled header that CMake makes for this file.
