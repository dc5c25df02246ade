// Typed data out of glTF buffers. Every offset is computed in 128 bits or checked before it is used.
#include "scene/gltf.h"

#include <cstring>

namespace ssrlab::gltf {
namespace {

struct Layout {
    const unsigned char* data           = nullptr; // null: all zeros
    uint64_t             stride         = 0;
    uint64_t             count          = 0;
    int                  component_type = 0;
    int                  components     = 0;
    bool                 normalized     = false;
};

template <typename Items>
const auto& at(const Import& import, const Items& items, int index, const char* kind, const std::string& where)
{
    if (index < 0 || static_cast<size_t>(index) >= items.size())
        import.fail("{}: there is no {} {}", where, kind, index);
    return items[static_cast<size_t>(index)];
}

/// Where `count` elements of `size` bytes begin, after checking that they all lie inside.
const unsigned char* checked_range(const Import& import, int view_index, uint64_t offset, uint64_t stride,
                                   uint64_t count, uint64_t size, const std::string& where)
{
    const tinygltf::BufferView& view   = at(import, import.json.bufferViews, view_index, "buffer view", where);
    const tinygltf::Buffer&     buffer = at(import, import.json.buffers, view.buffer, "buffer", where);
    using Wide                         = unsigned __int128;
    const Wide end                     = Wide(offset) + Wide(stride) * (count - 1) + size;
    const Wide view_end                = Wide(view.byteOffset) + view.byteLength;
    if (count == 0 || end > view.byteLength || view_end > buffer.data.size())
        import.fail("{}: {} elements reach beyond buffer view {}", where, count, view_index);
    return buffer.data.data() + view.byteOffset + offset;
}

Layout layout_of(const Import& import, int index, const std::string& where)
{
    const tinygltf::Accessor& accessor = at(import, import.json.accessors, index, "accessor", where);
    Layout                    layout;
    layout.count          = accessor.count;
    layout.component_type = accessor.componentType;
    layout.components     = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    layout.normalized     = accessor.normalized;
    const int size        = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    if (size <= 0 || layout.components <= 0) import.fail("{}: accessor {} has an unknown type", where, index);
    if (layout.component_type == TINYGLTF_COMPONENT_TYPE_INT || layout.component_type == TINYGLTF_COMPONENT_TYPE_DOUBLE)
        import.fail("{}: accessor {}: expected componentType 5120 to 5123, 5125 or 5126, got {}", where, index,
                    layout.component_type);
    if (layout.count == 0 || layout.count > max_accessor_rows)
        import.fail("{}: accessor {} has {} elements; 1 to {} can be loaded", where, index, layout.count,
                    max_accessor_rows);
    const auto element = static_cast<uint64_t>(size) * static_cast<uint64_t>(layout.components);
    if (accessor.bufferView >= 0) {
        const tinygltf::BufferView& view =
            at(import, import.json.bufferViews, accessor.bufferView, "buffer view", where);
        layout.stride = view.byteStride != 0 ? view.byteStride : element;
        layout.data   = checked_range(import, accessor.bufferView, accessor.byteOffset, layout.stride, layout.count,
                                      element, where);
    } else if (layout.count > max_objects) {
        import.fail("{}: accessor {} has {} elements but no data", where, index, layout.count);
    }
    return layout;
}

template <typename T> double component_as(const unsigned char* from)
{
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

double component(const unsigned char* from, int type, bool normalized)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return normalized ? std::max(component_as<int8_t>(from) / 127, -1.0) : component_as<int8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return component_as<uint8_t>(from) / (normalized ? 255 : 1);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return normalized ? std::max(component_as<int16_t>(from) / 32767, -1.0) : component_as<int16_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return component_as<uint16_t>(from) / (normalized ? 65535 : 1);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return component_as<uint32_t>(from);
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return component_as<float>(from);
    default: return 0;
    }
}

/// Replaces the elements that a sparse accessor stores apart.
template <typename Value>
void apply_sparse(const Import& import, int index, const Layout& layout, std::vector<Value>& rows,
                  const std::string& where)
{
    const auto& sparse = import.json.accessors[static_cast<size_t>(index)].sparse;
    if (!sparse.isSparse) return;
    const int index_size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType));
    const int size       = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(layout.component_type));
    if (sparse.count <= 0)
        import.fail("{}: accessor {}: expected a sparse count above 0, got {}", where, index, sparse.count);
    if (index_size <= 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        import.fail("{}: accessor {} has a broken sparse part", where, index);
    const auto  count   = static_cast<uint64_t>(sparse.count);
    const auto  element = static_cast<uint64_t>(size) * static_cast<uint64_t>(layout.components);
    const auto* indices =
        checked_range(import, sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset),
                      static_cast<uint64_t>(index_size), count, static_cast<uint64_t>(index_size), where);
    const auto* values = checked_range(import, sparse.values.bufferView,
                                       static_cast<uint64_t>(sparse.values.byteOffset), element, count, element, where);
    for (uint64_t i = 0; i < count; ++i) {
        const auto row = static_cast<uint64_t>(
            component(indices + i * static_cast<uint64_t>(index_size), sparse.indices.componentType, false));
        if (row >= layout.count) import.fail("{}: accessor {}: sparse index {} is out of range", where, index, row);
        for (int c = 0; c < layout.components; ++c)
            rows[row * static_cast<uint64_t>(layout.components) + static_cast<uint64_t>(c)] =
                static_cast<Value>(component(values + i * element + static_cast<uint64_t>(c * size),
                                             layout.component_type, layout.normalized));
    }
}

} // namespace

int component_count(const Import& import, int accessor, const std::string& where)
{
    return layout_of(import, accessor, where).components;
}

std::vector<float> read_floats(const Import& import, int accessor, int components, const std::string& where)
{
    const Layout layout = layout_of(import, accessor, where);
    if (layout.components != components)
        import.fail("{}: accessor {} has {} components, {} are expected", where, accessor, layout.components,
                    components);
    const auto width = static_cast<uint64_t>(components);
    const auto size =
        static_cast<uint64_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(layout.component_type)));
    std::vector<float> rows(layout.count * width, 0.0F);
    if (layout.data != nullptr)
        for (uint64_t i = 0; i < layout.count; ++i)
            for (uint64_t c = 0; c < width; ++c)
                rows[i * width + c] = static_cast<float>(
                    component(layout.data + i * layout.stride + c * size, layout.component_type, layout.normalized));
    apply_sparse(import, accessor, layout, rows, where);
    return rows;
}

std::vector<uint32_t> read_indices(const Import& import, int accessor, const std::string& where)
{
    const Layout layout = layout_of(import, accessor, where);
    const bool   whole  = layout.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                       layout.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                       layout.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (layout.components != 1 || !whole) import.fail("{}: accessor {} cannot be used as indices", where, accessor);
    std::vector<uint32_t> indices(layout.count, 0);
    for (uint64_t i = 0; layout.data != nullptr && i < layout.count; ++i)
        indices[i] = static_cast<uint32_t>(component(layout.data + i * layout.stride, layout.component_type, false));
    apply_sparse(import, accessor, layout, indices, where);
    return indices;
}

} // namespace ssrlab::gltf
