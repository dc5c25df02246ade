#include "targets.h"

#include "unit/temp_folder.h"

namespace ssrlab::fuzz {

std::filesystem::path file_with(const std::string& name, const std::string& text)
{
    static const TempFolder folder;
    return folder.write(name, text);
}

std::filesystem::path file_with(const std::string& name, Bytes bytes)
{
    return file_with(name, std::string(bytes.begin(), bytes.end()));
}

} // namespace ssrlab::fuzz
