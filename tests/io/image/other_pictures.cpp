#include "engine/io/codec/picture_codec.h"

extern "C" const reljef::io::PictureModule* reljef_picture_module();

const reljef::io::PictureModule* reljef_picture_module() {
    static const reljef::io::PictureModule module{"another interface", nullptr};
    return &module;
}
