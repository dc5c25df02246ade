#include "targets.h"

#include "core/toml_reading.h"

namespace ssrlab::fuzz {

void feed_toml(Bytes bytes) { parse_toml("file.toml", std::string(bytes.begin(), bytes.end())); }

} // namespace ssrlab::fuzz
