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
#include <type_traits>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

// Raise when the code computes another truth from the same input, or writes it in another form.
constexpr uint32_t format_version = 12, bounced_version = 1;

struct Header {
    std::array<char, 8> magic{'S', 'S', 'R', 'T', 'R', 'U', 'T', 'H'};
    uint64_t            payload_bytes = 0;
    XXH128_hash_t       key{}; // of the input: a file under another's name is not read
    XXH128_hash_t       checksum{};
};
static_assert(sizeof(Header) == 48);

void add(ContentHash& hash, const GBufferImage& gbuffer)
{
    const View& view = gbuffer.view;
    hash.add(view.size_px).add(view.projection).add(view.world_to_view).add(view.focal_px).add(view.centre_px);
    hash.add(view.near_m).add(view.far_m).add(gbuffer.depth).add(gbuffer.normal_vs).add(gbuffer.metallic);
    hash.add(gbuffer.roughness.size()).add(gbuffer.roughness);
    hash.add(gbuffer.dielectric_f0.size()).add(gbuffer.dielectric_f0);
    hash.add(gbuffer.gradient.size()).add(gbuffer.gradient).add(gbuffer.solid_back.size()).add(gbuffer.solid_back);
}

/// What decides which pixels reflect.
void add_reflecting(ContentHash& hash, const TraceSettings& settings)
{
    hash.add(settings.dielectric_min_f0).add(settings.dielectric_max_roughness);
}

void add(ContentHash& hash, const TraceSettings& settings)
{
    add_reflecting(hash, settings);
    hash.add(settings.thickness_m).add(settings.thickness_relative).add(settings.max_distance_m);
    hash.add(settings.ray_offset_m).add(settings.behind).add(settings.layers);
    hash.add_bytes(settings.surface.data(), settings.surface.size());
}

void add(ContentHash& hash, const TextureUse& use) { hash.add(use.texture).add(use.uv_set).add(use.uv_transform); }

void add(ContentHash& hash, const Scene& scene)
{
    // The lengths too: otherwise values could move from one list into the next unnoticed.
    hash.add(scene.draws.size()).add(scene.materials.size()).add(scene.textures.size()).add(scene.lights.size());
    static_assert(sizeof(Vertex) == 21 * sizeof(float), "padding would make the hash random");
    hash.add_bytes(scene.vertices.data(), scene.vertices.size() * sizeof(Vertex)).add(scene.indices);
    for (const Draw& draw : scene.draws) hash.add(draw.first_index).add(draw.index_count).add(draw.material);
    for (const Material& m : scene.materials) {
        hash.add(m.base_colour)
            .add(m.metallic)
            .add(m.roughness)
            .add(m.dielectric_f0)
            .add(m.emissive)
            .add(m.double_sided)
            .add(m.alpha_mask)
            .add(m.normal_scale)
            .add(m.alpha_cutoff);
        for (const TextureUse* use :
             {&m.base_colour_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emissive_texture})
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
    template <typename T> void operator()(const T& value)
    {
        const auto* bytes = reinterpret_cast<const char*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
    }
    std::vector<char> take() { return std::move(bytes_); }

private:
    std::vector<char> bytes_;
};

class Reader {
public:
    explicit Reader(const std::vector<char>& bytes) : bytes_(bytes) {}

    template <typename T> void operator()(T& value)
    {
        if (bytes_.size() - place_ < sizeof value) {
            ok_ = false;
            return;
        }
        std::memcpy(static_cast<void*>(&value), bytes_.data() + place_, sizeof value);
        place_ += sizeof value;
    }
    bool complete() const { return ok_ && place_ == bytes_.size(); }

private:
    const std::vector<char>& bytes_;
    size_t                   place_ = 0;
    bool                     ok_    = true;
};

std::optional<std::vector<char>> read_payload(const fs::path& path, XXH128_hash_t key)
{
    std::ifstream   file(path, std::ios::binary);
    std::error_code error;
    const auto      file_bytes = fs::file_size(path, error);
    Header          header;
    if (error || file_bytes < sizeof header || !file.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
    if (header.magic != Header{}.magic || !XXH128_isEqual(header.key, key)) return {};
    if (header.payload_bytes != file_bytes - sizeof header) return {};
    std::vector<char> payload(header.payload_bytes);
    if (!file.read(payload.data(), std::streamsize(payload.size()))) return {};
    if (!XXH128_isEqual(XXH3_128bits(payload.data(), payload.size()), header.checksum)) return {};
    return payload;
}

void write_payload(const fs::path& path, XXH128_hash_t key, const std::vector<char>& payload)
{
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    const fs::path temporary = path.parent_path() / fmt::format(".{}.{}.tmp", path.filename().string(), getpid());
    Header         header;
    header.payload_bytes = payload.size();
    header.key           = key;
    header.checksum      = XXH3_128bits(payload.data(), payload.size());
    std::ofstream file(temporary, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.write(payload.data(), std::streamsize(payload.size()));
    file.close();
    if (file) fs::rename(temporary, path, error);
    if (!file || error) fs::remove(temporary, error);
}

// The order of a file's values, for writing and for reading. It holds only what is defined: a miss is its status and its steps.
template <typename Pass> void pass_values(Pass& pass, TraceImage& result)
{
    for (size_t i = 0; i < result.status.size(); ++i) {
        pass(result.status[i]);
        if (result.status[i] != TraceStatus::not_traced) pass(result.steps[i]);
        if (!has_place(result.status[i])) continue;
        pass(result.hit_pixel[i]);
        pass(result.hit_layer[i]);
        pass(result.hit_px_depth[i]);
        pass(result.hit_t[i]);
    }
}

template <typename Pass> void pass_values(Pass& pass, SceneTruth& truth)
{
    pass(truth.off_surface);
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        pass(truth.cls[i]);
        if (truth.cls[i] == TruthClass::not_traced) continue;
        pass(truth.radiance[i]);
        if (truth.cls[i] == TruthClass::sky) {
            truth.distance_m[i] = std::numeric_limits<double>::infinity();
            continue;
        }
        pass(truth.point_vs[i]);
        pass(truth.point_px[i]);
        pass(truth.distance_m[i]);
    }
}

template <typename Pass> void pass_values(Pass& pass, GlossyTruth& truth)
{
    for (size_t i = 0; i < truth.rays.size(); ++i) {
        pass(truth.rays[i]);
        if (truth.rays[i] == 0) continue;
        pass(truth.radiance[i]);
        pass(truth.noise[i]);
        pass(truth.albedo[i]);
    }
}

/// Without anything traced.
template <typename Truth> Truth empty_truth(glm::ivec2 size_px)
{
    if constexpr (std::is_same_v<Truth, SceneTruth>) return empty_scene_truth(size_px);
    if constexpr (std::is_same_v<Truth, GlossyTruth>) return empty_glossy_truth(size_px);
    if constexpr (std::is_same_v<Truth, TraceImage>) return make_trace_image(size_px, false);
}

/// kind: begins the file's name.
template <typename Truth, typename Compute>
Truth cached(const fs::path& cache_dir, std::string_view kind, const ContentHash& input, glm::ivec2 size_px,
             const Compute& compute)
{
    if (cache_dir.empty()) return compute();
    const fs::path path = cache_dir / fmt::format("{}_{}.truth", kind, input.hex());
    if (const auto payload = read_payload(path, input.digest())) {
        Truth  truth = empty_truth<Truth>(size_px);
        Reader reader(*payload);
        pass_values(reader, truth);
        if (reader.complete()) return truth;
    }
    Truth  truth = compute();
    Writer writer;
    pass_values(writer, truth);
    write_payload(path, input.digest(), writer.take());
    return truth;
}

} // namespace

TraceImage cached_screen_truth(const fs::path& cache_dir, const GBufferImage& gbuffer, const TraceSettings& settings,
                               unsigned threads)
{
    require_complete(gbuffer);
    ContentHash hash;
    add(hash.add(format_version), gbuffer);
    for (int layer = 1; layer < layer_count(gbuffer, settings); ++layer) add(hash, layer_of(gbuffer, layer));
    add(hash, settings);
    return cached<TraceImage>(cache_dir, "screen", hash, gbuffer.view.size_px,
                              [&] { return screen_truth(gbuffer, settings, threads); });
}

SceneTruth cached_scene_truth(const fs::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                              const TraceSettings& settings, unsigned threads)
{
    require_complete(gbuffer);
    ContentHash hash;
    add(hash.add(format_version), gbuffer);
    hash.add(gbuffer.radiance).add(settings.max_distance_m);
    add_reflecting(hash, settings); // of the settings, only these matter
    add(hash, scene);
    return cached<SceneTruth>(cache_dir, "scene", hash, gbuffer.view.size_px,
                              [&] { return scene_truth(SceneBvh(scene), scene, gbuffer, settings, threads); });
}

GlossyTruth cached_glossy_truth(const fs::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                                const TraceSettings& settings, const GlossySettings& glossy, unsigned threads)
{
    require_complete(gbuffer);
    ContentHash hash;
    add(hash.add(format_version), gbuffer);
    hash.add(gbuffer.radiance).add(gbuffer.base_colour).add(settings.max_distance_m);
    hash.add(glossy.rays).add(glossy.first).add(glossy.bounces).add(glossy.seed);
    if (glossy.metallic_exponent) hash.add(true); // rays are the same for all exponents
    add_reflecting(hash, settings);
    add(hash, scene);
    GlossyTruth truth = cached<GlossyTruth>(cache_dir, "glossy", hash, gbuffer.view.size_px, [&] {
        return glossy_truth(SceneBvh(scene), scene, gbuffer, settings, glossy, threads);
    });
    truth.metallic_exponent = glossy.metallic_exponent;
    return truth;
}

std::string bounced_light_key(const Scene& scene)
{
    ContentHash hash;
    add(hash.add(bounced_version), scene);
    return hash.add(scene.bake->edge_m).add(scene.bake->paths).add(scene.bake->bounces).hex();
}

} // namespace ssrlab
