// Small scene files, written where a test wants them.
#pragma once

#include "core/error.h"
#include "scene/scene.h"
#include "temp_folder.h"
#include "test.h"

namespace ssrlab {

/// A glTF under construction: JSON beside one binary buffer.
struct GltfFile {
    nlohmann::json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string    binary;

    template <typename T> int add_accessor(const std::vector<T>& values, const char* type, int components)
    {
        constexpr int  component_type = sizeof(T) == 2 ? 5123 : std::is_floating_point_v<T> ? 5126 : 5125;
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}};
        binary.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        binary.resize((binary.size() + 3) / 4 * 4);
        root["bufferViews"].push_back(view);
        root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", values.size() / static_cast<size_t>(components)},
                                     {"type", type}});
        return static_cast<int>(root["accessors"].size()) - 1;
    }

    int positions(const std::vector<float>& xyz) { return add_accessor(xyz, "VEC3", 3); }

    /// One triangle in the plane z = 0 facing +z, as mesh 0 on node 0.
    static GltfFile triangle()
    {
        GltfFile  file;
        const int accessor  = file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
        file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", accessor}}}}}}}};
        file.root["nodes"]  = {{{"mesh", 0}}};
        return file;
    }

    nlohmann::json& primitive() { return root["meshes"][0]["primitives"][0]; }

    /// One file; its first buffer is the binary chunk.
    std::string glb()
    {
        root["buffers"][0] = {{"byteLength", binary.size()}};
        std::string text   = root.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const auto word = [](size_t value) {
            const auto value32 = static_cast<uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&value32), 4);
        };
        return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
               word(binary.size()) + std::string("BIN\0", 4) + binary;
    }

    std::string write(const TempFolder& folder, const std::string& name = "scene.gltf")
    {
        if (!binary.empty() && !root.contains("buffers"))
            root["buffers"] = {{{"uri", "data.bin"}, {"byteLength", binary.size()}}};
        folder.write("data.bin", binary);
        return folder.write(name, root.dump());
    }

    Scene load()
    {
        const TempFolder folder;
        return load_scene(write(folder));
    }
};

/// The message of the Failure or SpecError that loading throws; a test failure when it throws nothing.
template <typename Error> std::string error_of(const std::string& scene)
{
    try {
        load_scene(scene);
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << scene << " loaded without the expected error";
    return {};
}

inline glm::vec3 corner(const Scene& scene, size_t index) { return scene.vertices[scene.indices[index]].position_ws; }

inline glm::vec3 geometric_normal(const Scene& scene, size_t triangle)
{
    const size_t i = 3 * triangle;
    return glm::normalize(glm::cross(corner(scene, i + 1) - corner(scene, i), corner(scene, i + 2) - corner(scene, i)));
}

#define EXPECT_VEC_NEAR(a, b, tolerance) \
    EXPECT_LE(glm::length((a) - (b)), tolerance) << "where x, y, z = " << (a).x << ", " << (a).y << ", " << (a).z

#define ASSERT_VEC_NEAR(a, b, tolerance) ASSERT_LE(glm::length((a) - (b)), tolerance)

} // namespace ssrlab
