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

WgslVerdicts verify_wgsl_export(const fs::path& folder)
{
    const TemporaryFolder answers("ssrlab_answers");
    WgslVerdicts          found;
    for_each_frame(folder, [](const fs::path& file) { json::parse(read_file(file)).at("resources").at("rays"); });
    const ProgramEnd done = run_program(
        {"node", (web_folder() / "verify.mjs").string(), fs::absolute(folder).string(), answers.path.string()},
        ProgramOutput::kept);
    if (done.code == program_is_missing) throw_failure("node is not installed: install Debian's package nodejs");
    if (done.code != 0) throw_failure("{}: {}", folder.string(), done.output.substr(0, done.output.find('\n')));
    found.device = read_file(answers.path / "device.txt");
    for_each_frame(folder, [&](const fs::path& file) {
        const json        frame = json::parse(read_file(file));
        const std::string name  = file.stem().string();
        Answers           given{.hits = read_words(answers.path / (name + ".hits.bin"))};
        if (frame.at("expected").contains("made_rays")) {
            given.made_rays  = read_words(answers.path / (name + ".made_rays.bin"));
            given.made_count = read_words(answers.path / (name + ".made_count.bin")).at(0);
        }
        found.frames.push_back(compare_answers(frame, file, given));
    });
    return found;
}

} // namespace ssrlab
