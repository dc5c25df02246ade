#include "truth/truth_cache.h"

#include "core/pixel_index.h"
#include "truth/content_hash.h"
#include "truth/screen_ray.h"

#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

// Raise when the code computes another truth from the same input, or writes it in another form.
constexpr uint32_t format_version = 2;

struct Header {
    std::array<char, 8> magic{'S', 'S', 'R', 'T', 'R', 'U', 'T', 'H'};
    uint64_t            payload_bytes = 0;
    XXH128_hash_t       checksum{};
};
static_assert(sizeof(Header) == 32);

void add(ContentHash& hash, const GBufferImage& gbuffer)
{
    const View& view = gbuffer.view;
    hash.add(view.size_px).add(view.projection).add(view.world_to_view).add(view.focal_px).add(view.centre_px);
    hash.add(view.near_m).add(view.far_m).add(gbuffer.depth).add(gbuffer.normal_vs).add(gbuffer.metallic);
}

void add(ContentHash& hash, const TraceSettings& settings)
{
    hash.add(settings.thickness_m).add(settings.thickness_relative).add(settings.max_distance_m);
    hash.add(settings.ray_offset_m).add(settings.facing);
}

void add(ContentHash& hash, const TextureUse& use) { hash.add(use.texture).add(use.uv_set).add(use.uv_transform); }

void add(ContentHash& hash, const Scene& scene)
{
    // The lengths too: otherwise values could move from one list into the next unnoticed.
    hash.add(scene.draws.size()).add(scene.materials.size()).add(scene.textures.size()).add(scene.lights.size());
    static_assert(sizeof(Vertex) == 18 * sizeof(float), "padding would make the hash random");
    hash.add_bytes(scene.vertices.data(), scene.vertices.size() * sizeof(Vertex)).add(scene.indices);
    for (const Draw& draw : scene.draws) hash.add(draw.first_index).add(draw.index_count).add(draw.material);
    for (const Material& m : scene.materials) {
        hash.add(m.base_colour)
            .add(m.metallic)
            .add(m.emissive)
            .add(m.double_sided)
            .add(m.alpha_mask)
            .add(m.alpha_cutoff);
        for (const TextureUse* use : {&m.base_colour_texture, &m.metallic_roughness_texture, &m.emissive_texture})
            add(hash, *use);
    }
    for (const Texture& t : scene.textures) {
        hash.add(t.size_px).add(t.rgba).add(t.srgb).add(t.nearest).add(t.wrap_u).add(t.wrap_v);
    }
    for (const Light& l : scene.lights) {
        hash.add(l.type).add(l.position_ws).add(l.direction_ws).add(l.intensity).add(l.range_m);
        hash.add(l.inner_angle_rad).add(l.outer_angle_rad).add(l.casts_shadow);
    }
    hash.add(scene.ambient).add(scene.background).add(scene.environment.size_px);
    const std::vector<glm::vec3>& sky = scene.environment.radiance;
    hash.add_bytes(sky.data(), sky.size() * sizeof(glm::vec3));
}

class Writer {
public:
    template <typename T> void put(const T& value)
    {
        const auto* bytes = reinterpret_cast<const char*>(&value);
        m_bytes.insert(m_bytes.end(), bytes, bytes + sizeof value);
    }
    std::vector<char> take() { return std::move(m_bytes); }

private:
    std::vector<char> m_bytes;
};

class Reader {
public:
    explicit Reader(const std::vector<char>& bytes) : m_bytes(bytes) {}

    template <typename T> void get(T& value)
    {
        if (m_bytes.size() - m_place < sizeof value) {
            m_ok = false;
            return;
        }
        std::memcpy(static_cast<void*>(&value), m_bytes.data() + m_place, sizeof value);
        m_place += sizeof value;
    }
    bool complete() const { return m_ok && m_place == m_bytes.size(); }

private:
    const std::vector<char>& m_bytes;
    size_t                   m_place = 0;
    bool                     m_ok    = true;
};

std::optional<std::vector<char>> read_payload(const fs::path& path)
{
    std::ifstream   file(path, std::ios::binary);
    std::error_code error;
    const auto      file_bytes = fs::file_size(path, error);
    Header          header;
    if (error || file_bytes < sizeof header || !file.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
    if (header.magic != Header{}.magic || header.payload_bytes != file_bytes - sizeof header) return {};
    std::vector<char> payload(header.payload_bytes);
    if (!file.read(payload.data(), std::streamsize(payload.size()))) return {};
    if (!XXH128_isEqual(XXH3_128bits(payload.data(), payload.size()), header.checksum)) return {};
    return payload;
}

void write_payload(const fs::path& path, const std::vector<char>& payload)
{
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    const fs::path temporary = path.parent_path() / fmt::format(".{}.{}.tmp", path.filename().string(), getpid());
    Header         header;
    header.payload_bytes = payload.size();
    header.checksum      = XXH3_128bits(payload.data(), payload.size());
    std::ofstream file(temporary, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.write(payload.data(), std::streamsize(payload.size()));
    file.close();
    if (file) fs::rename(temporary, path, error);
    if (!file || error) fs::remove(temporary, error);
}

// Both forms hold only what is defined: a miss is its status and its steps.
std::vector<char> pack(const TraceResult& result)
{
    Writer writer;
    for (size_t i = 0; i < result.status.size(); ++i) {
        writer.put(result.status[i]);
        if (result.status[i] != TraceStatus::not_traced) writer.put(result.steps[i]);
        if (result.status[i] != TraceStatus::hit) continue;
        writer.put(result.hit_pixel[i]);
        writer.put(result.hit_px_depth[i]);
        writer.put(result.hit_t[i]);
    }
    return writer.take();
}

bool unpack(const std::vector<char>& payload, glm::ivec2 size_px, TraceResult& result)
{
    const size_t count = pixel_count(size_px);
    result             = make_trace_result(size_px, false);
    Reader reader(payload);
    for (size_t i = 0; i < count; ++i) {
        reader.get(result.status[i]);
        if (result.status[i] != TraceStatus::not_traced) reader.get(result.steps[i]);
        if (result.status[i] != TraceStatus::hit) continue;
        reader.get(result.hit_pixel[i]);
        reader.get(result.hit_px_depth[i]);
        reader.get(result.hit_t[i]);
    }
    return reader.complete();
}

std::vector<char> pack(const SceneTruth& truth)
{
    Writer writer;
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        writer.put(truth.cls[i]);
        if (truth.cls[i] == TruthClass::not_traced) continue;
        writer.put(truth.radiance[i]);
        if (truth.cls[i] == TruthClass::sky) continue;
        writer.put(truth.point_vs[i]);
        writer.put(truth.point_px[i]);
        writer.put(truth.distance_m[i]);
    }
    return writer.take();
}

bool unpack(const std::vector<char>& payload, glm::ivec2 size_px, SceneTruth& truth)
{
    truth = empty_scene_truth(size_px);
    Reader reader(payload);
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        reader.get(truth.cls[i]);
        if (truth.cls[i] == TruthClass::not_traced) continue;
        reader.get(truth.radiance[i]);
        truth.distance_m[i] = std::numeric_limits<double>::infinity();
        if (truth.cls[i] == TruthClass::sky) continue;
        reader.get(truth.point_vs[i]);
        reader.get(truth.point_px[i]);
        reader.get(truth.distance_m[i]);
    }
    return reader.complete();
}

std::vector<char> pack(const GlossyTruth& truth)
{
    Writer writer;
    for (size_t i = 0; i < truth.rays.size(); ++i) {
        writer.put(truth.rays[i]);
        if (truth.rays[i] == 0) continue;
        writer.put(truth.radiance[i]);
        writer.put(truth.standard_error[i]);
        writer.put(truth.weight[i]);
    }
    return writer.take();
}

bool unpack(const std::vector<char>& payload, glm::ivec2 size_px, GlossyTruth& truth)
{
    truth = empty_glossy_truth(size_px);
    Reader reader(payload);
    for (size_t i = 0; i < truth.rays.size(); ++i) {
        reader.get(truth.rays[i]);
        if (truth.rays[i] == 0) continue;
        reader.get(truth.radiance[i]);
        reader.get(truth.standard_error[i]);
        reader.get(truth.weight[i]);
    }
    return reader.complete();
}

template <typename Truth, typename Compute>
Truth cached(const fs::path& path, glm::ivec2 size_px, const Compute& compute)
{
    Truth truth;
    if (const auto payload = read_payload(path); payload && unpack(*payload, size_px, truth)) return truth;
    truth = compute();
    write_payload(path, pack(truth));
    return truth;
}

} // namespace

TraceResult cached_screen_truth(const fs::path& cache_dir, const GBufferImage& gbuffer, const TraceSettings& settings,
                                unsigned threads)
{
    require_complete(gbuffer);
    ContentHash hash;
    add(hash.add(format_version), gbuffer);
    add(hash, settings);
    return cached<TraceResult>(cache_dir / fmt::format("screen_{}.truth", hash.hex()), gbuffer.view.size_px,
                               [&] { return screen_truth(gbuffer, settings, threads); });
}

SceneTruth cached_scene_truth(const fs::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                              const TraceSettings& settings, unsigned threads)
{
    require_complete(gbuffer);
    ContentHash hash;
    add(hash.add(format_version), gbuffer);
    hash.add(gbuffer.radiance).add(settings.max_distance_m); // of the settings, only this one matters
    add(hash, scene);
    return cached<SceneTruth>(cache_dir / fmt::format("scene_{}.truth", hash.hex()), gbuffer.view.size_px,
                              [&] { return scene_truth(SceneBvh(scene), scene, gbuffer, settings, threads); });
}

GlossyTruth cached_glossy_truth(const fs::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                                const TraceSettings& settings, const GlossySettings& glossy, unsigned threads)
{
    require_complete(gbuffer);
    ContentHash hash;
    add(hash.add(format_version), gbuffer);
    hash.add(gbuffer.radiance).add(gbuffer.roughness).add(settings.max_distance_m).add(glossy.rays).add(glossy.seed);
    add(hash, scene);
    return cached<GlossyTruth>(cache_dir / fmt::format("glossy_{}.truth", hash.hex()), gbuffer.view.size_px, [&] {
        return glossy_truth(SceneBvh(scene), scene, gbuffer, settings, glossy, threads);
    });
}

} // namespace ssrlab
