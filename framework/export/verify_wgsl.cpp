// Runs an export's WGSL in a browser without a window.
#include "core/error.h"
#include "core/files.h"
#include "core/run_program.h"
#include "core/temporary_folder.h"
#include "export/answers.h"
#include "export/wgsl.h"

#include <nlohmann/json.hpp>

namespace ssrlab {

namespace fs = std::filesystem;
using nlohmann::json;

bool is_wgsl_export(const fs::path& folder)
{
    if (!fs::is_directory(folder)) return false;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".wgsl") return true;
    return false;
}

WgslVerdicts verify_wgsl_exports(std::span<const fs::path> folders)
{
    const TemporaryFolder    answers("ssrlab_answers");
    std::vector<std::string> words{"node", (web_folder() / "verify.mjs").string(), answers.path.string()};
    for (const fs::path& folder : folders) {
        for_each_frame(folder, [](const fs::path& file) { require_sizes(json::parse(read_file(file)), file); });
        words.push_back(fs::absolute(folder).string());
    }
    const ProgramEnd done = run_program(words, ProgramOutput::kept);
    if (done.code == program_is_missing) throw_failure("node is not installed: install Debian's package nodejs");
    if (done.code != 0) throw Failure(done.output.substr(0, done.output.find('\n')));
    WgslVerdicts found;
    found.device = read_file(answers.path / "device.txt");
    for (size_t i = 0; i < folders.size(); ++i)
        for_each_frame(folders[i], [&](const fs::path& file) {
            const json frame = json::parse(read_file(file));
            const auto read  = [&](const char* what) {
                return read_words(answers.path / fmt::format("{}.{}.{}.bin", i, file.stem().string(), what));
            };
            Answers given{.hits = read("hits")};
            if (frame.at("expected").contains("made_rays")) {
                given.made_rays  = read("made_rays");
                given.made_count = read("made_count").at(0);
            }
            found.frames.push_back(compare_answers(frame, file, given));
        });
    return found;
}

} // namespace ssrlab
