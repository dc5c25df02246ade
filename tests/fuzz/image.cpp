#include "targets.h"

#include "scene/image_file.h"

namespace ssrlab::fuzz {

void feed_image(Bytes bytes) { decode_image(bytes, "image.tga"); }

} // namespace ssrlab::fuzz
