#include "app/shaders_command.h"

#include "core/error.h"
#include "core/files.h"
#include "core/version.h"
#include "harness/choice.h"
#include "trace/technique_files.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace ssrlab {
namespace {

struct Row {
    CompiledPtr              pipeline;
    LoopCode                 loop;
    std::vector<std::string> techniques; // whose frames use it
};

/// Techniques that bind different buffers to the same code share a row.
bool same_code(const CompiledPipeline& a, const CompiledPipeline& b)
{
    return a.shader == b.shader && !a.assembly.empty() && a.assembly == b.assembly;
}

/// "trace/trace.comp"
std::string short_name(const CompiledPipeline& pipeline)
{
    const std::filesystem::path file = pipeline.shader;
    return (file.parent_path().filename() / file.filename()).string();
}

/// The frame of a technique.
struct TechniqueFrame {
    std::string   technique;
    CompiledFrame compiled;

    double a_pixel(uint64_t count) const
    {
        return static_cast<double>(count) / compiled.size_px.x / compiled.size_px.y;
    }
};

std::vector<TechniqueFrame> compile(Gpu& gpu, const Catalogue& catalogue,
                                    const std::vector<const Technique*>& techniques, const std::vector<Choice>& choices)
{
    std::vector<TechniqueFrame> frames;
    for (size_t i = 0; i < techniques.size(); ++i)
        frames.push_back(
            {techniques[i]->id, compile_frame(gpu, catalogue, *techniques[i], choices[i].values, choices[i].settings)});
    return frames;
}

std::vector<Row> pipelines_of(const std::vector<TechniqueFrame>& frames)
{
    std::vector<Row> rows;
    for (const TechniqueFrame& frame : frames)
        for (const CompiledPtr& pipeline : frame.compiled.pipelines) {
            auto row = std::ranges::find_if(rows, [&](const Row& known) {
                return known.pipeline == pipeline || same_code(*known.pipeline, *pipeline);
            });
            if (row == rows.end()) row = rows.insert(row, {pipeline, innermost_loop(pipeline->assembly), {}});
            if (row->techniques.empty() || row->techniques.back() != frame.technique)
                row->techniques.push_back(frame.technique);
        }
    return rows;
}

/// A column of the table; several names are summed. AMD's compiler has all of them, others some.
struct Column {
    const char*              title;
    std::vector<const char*> statistics;
};

const std::vector<Column>& columns()
{
    static const std::vector<Column> all = {{"VGPRs", {"VGPRs"}},
                                            {"SGPRs", {"SGPRs"}},
                                            {"waves a SIMD", {"Subgroups per SIMD"}},
                                            {"spilled", {"Spilled VGPRs", "Spilled SGPRs"}},
                                            {"LDS B", {"LDS size"}},
                                            {"scratch B", {"Scratch size"}},
                                            {"code B", {"Code size"}},
                                            {"instructions", {"Instructions"}}};
    return all;
}

std::string cell(const Row& row, const Column& column)
{
    const auto& statistics = row.pipeline->statistics;
    uint64_t    sum        = 0;
    for (const char* name : column.statistics) {
        if (!statistics.contains(name)) return "-";
        sum += statistics.at(name);
    }
    return std::to_string(sum);
}

void print_table(const std::vector<Row>& rows, size_t techniques)
{
    std::string head = "| technique | shader | group | lanes |", line = "|---|---|--:|--:|";
    for (const Column& column : columns()) {
        head += fmt::format(" {} |", column.title);
        line += "--:|";
    }
    std::puts((head + " in the innermost loop | loads there |\n" + line + "--:|--:|").c_str());
    for (const Row& row : rows) {
        const bool  shared = techniques > 1 && row.techniques.size() == techniques;
        std::string text   = fmt::format("| {} | `{}` | {} | {} |",
                                       shared ? "(all)" : fmt::format("{}", fmt::join(row.techniques, ", ")),
                                         short_name(*row.pipeline), row.pipeline->group, row.pipeline->lanes);
        for (const Column& column : columns()) text += fmt::format(" {} |", cell(row, column));
        const bool shown = !row.pipeline->assembly.empty();
        text += shown ? fmt::format(" {} | {} |", row.loop.instructions, row.loop.loads) : " - | - |";
        std::puts(text.c_str());
    }
}

/// Instructions and bytes of each pass, and of the frame.
void print_frames(const std::vector<TechniqueFrame>& frames, double bandwidth_gbps)
{
    const bool        timed = bandwidth_gbps > 0;
    const glm::ivec2  size  = frames.front().compiled.size_px;
    const std::string least = timed ? fmt::format(" least µs at {} GB/s |", bandwidth_gbps) : "";
    std::puts(fmt::format("\nA pixel of a {}x{} frame in which every pixel reflects and every ray hits\n\n"
                          "| technique | pass | instructions | bytes read | bytes written |{}\n|---|---|--:|--:|--:|{}",
                          size.x, size.y, least, timed ? "--:|" : "")
                  .c_str());
    for (const TechniqueFrame& frame : frames) {
        std::vector<PassTraffic> passes = frame.compiled.passes;
        passes.push_back(sum_of(passes));
        for (const PassTraffic& pass : passes)
            std::puts(fmt::format("| {} | {} | {} | {:.1f} | {:.1f} |{}", frame.technique, pass.pass,
                                  pass.instructions > 0 ? fmt::format("{:.1f}", frame.a_pixel(pass.instructions)) : "-",
                                  frame.a_pixel(pass.read_bytes), frame.a_pixel(pass.written_bytes),
                                  timed ? fmt::format(" {:.1f} |", 1e3 * least_ms(pass, bandwidth_gbps)) : "")
                          .c_str());
    }
}

nlohmann::json json_of(const TechniqueFrame& frame)
{
    nlohmann::json passes = nlohmann::json::array();
    for (const PassTraffic& pass : frame.compiled.passes)
        passes.push_back({{"pass", pass.pass},
                          {"instructions_a_pixel", frame.a_pixel(pass.instructions)},
                          {"bytes_read_a_pixel", frame.a_pixel(pass.read_bytes)},
                          {"bytes_written_a_pixel", frame.a_pixel(pass.written_bytes)}});
    return {{"technique", frame.technique}, {"passes", passes}};
}

void print_json(const std::vector<Row>& rows, const std::vector<TechniqueFrame>& frames, const GpuInfo& device)
{
    nlohmann::json json{{"commit", built_commit()},
                        {"device", device.name},
                        {"driver", device.driver},
                        {"pipelines", nlohmann::json::array()},
                        {"frames", nlohmann::json::array()}};
    for (const TechniqueFrame& frame : frames) json["frames"].push_back(json_of(frame));
    for (const Row& row : rows) {
        json["pipelines"].push_back({{"shader", short_name(*row.pipeline)},
                                     {"techniques", row.techniques},
                                     {"invocations_a_group", row.pipeline->group},
                                     {"lanes", row.pipeline->lanes},
                                     {"statistics", row.pipeline->statistics}});
        if (!row.pipeline->assembly.empty())
            json["pipelines"].back()["innermost_loop"] = {{"instructions", row.loop.instructions},
                                                          {"loads", row.loop.loads}};
    }
    std::puts(json.dump(1).c_str());
}

void write_assembly(const std::vector<Row>& rows, const std::filesystem::path& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw_failure("--assembly {}: cannot be created: {}", folder.string(), error.message());
    for (size_t i = 0; i < rows.size(); ++i) {
        const std::string name = fmt::format("{:02}_{}_{}.s", i, rows[i].techniques.front(),
                                             std::filesystem::path(rows[i].pipeline->shader).filename().string());
        write_file_atomically(folder / name, rows[i].pipeline->assembly);
    }
}

/// "  35  techniques/hiz/trace.glsl" for each, then the sum; generated texts have the names under which they are included.
void print_files(const std::vector<ShaderFile>& files, const std::string& title)
{
    const auto add = [](int sum, const ShaderFile& file) { return sum + file.code_lines; };
    std::puts(fmt::format("{}: {} lines of code in {} files", title,
                          std::accumulate(files.begin(), files.end(), 0, add), files.size())
                  .c_str());
    for (const ShaderFile& file : files) {
        const std::string inside = std::filesystem::path(file.name).lexically_relative(data_root()).string();
        const bool        own    = !inside.empty() && !inside.starts_with("..");
        std::puts(fmt::format("  {:4}  {}", file.code_lines, own ? inside : file.name).c_str());
    }
}

/// What the compiler reads of each technique, on an image of one pixel.
void print_technique_files(Gpu& gpu, const Catalogue& catalogue, const std::vector<const Technique*>& techniques,
                           const std::vector<Choice>& choices)
{
    const std::vector<float> depth   = {0.5F};
    const GBufferPtr         gbuffer = upload_depth(gpu, camera_to_view(Camera{}, {1, 1}), depth);
    for (size_t i = 0; i < techniques.size(); ++i) {
        const TraceSettings& settings = choices[i].settings.trace;
        const LabPtr         lab      = make_lab(gpu, catalogue, gbuffer, *techniques[i], choices[i].values, settings);
        const TechniqueFiles files    = technique_files(gpu, lab);
        print_files(files.technique, techniques[i]->id);
        print_files(files.ray_setup, "ray set-up, the same for all techniques, adds");
    }
}

} // namespace

int describe_shaders(const CommonOptions& common, const ShadersOptions& options)
{
    const Catalogue               catalogue = load_catalogue(common.technique_dirs);
    std::vector<const Technique*> techniques;
    for (const std::string& name : options.techniques)
        techniques.push_back(&find_technique(catalogue.techniques, name));
    if (techniques.empty())
        for (const Technique& technique : catalogue.techniques) techniques.push_back(&technique);
    const std::vector<Choice> choices = parse_choices(catalogue, techniques, options.parameters);

    GpuOptions device    = common.gpu;
    device.compiles_only = !options.files;
    if (!options.chip.empty()) pretend_chip(options.chip);
    Gpu gpu = open_gpu(device);
    if (options.files) {
        print_technique_files(gpu, catalogue, techniques, choices);
        return 0;
    }
    const std::vector<TechniqueFrame> frames = compile(gpu, catalogue, techniques, choices);
    const std::vector<Row>            rows   = pipelines_of(frames);
    if (options.json)
        print_json(rows, frames, gpu.info);
    else {
        std::puts(fmt::format("Compiled for {} by {}\n", gpu.info.name, gpu.info.driver).c_str());
        print_table(rows, techniques.size());
        print_frames(frames, options.bandwidth_gbps);
    }
    if (!options.assembly.empty()) write_assembly(rows, options.assembly);
    return 0;
}

} // namespace ssrlab
