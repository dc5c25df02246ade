// A hash of content: XXH3, 128 bit, over values in the order in which they are added.
#pragma once

#include <glm/glm.hpp>
#include <xxhash.h>

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ssrlab {

class ContentHash {
public:
    ContentHash() : state_(XXH3_createState(), XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

    /// Adds numbers, enums and GLM types: nothing with padding.
    template <typename T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T> ContentHash& add(T value)
    {
        return add_bytes(&value, sizeof value);
    }
    template <glm::length_t L, typename T, glm::qualifier Q> ContentHash& add(const glm::vec<L, T, Q>& value)
    {
        return add_bytes(&value, sizeof value);
    }
    template <glm::length_t C, glm::length_t R, typename T, glm::qualifier Q>
    ContentHash& add(const glm::mat<C, R, T, Q>& value)
    {
        return add_bytes(&value, sizeof value);
    }
    template <typename T>
    requires std::is_arithmetic_v<T> || requires { typename T::value_type; }
    ContentHash& add(const std::vector<T>& values)
    {
        return add(values.size()).add_bytes(values.data(), values.size() * sizeof(T));
    }

    ContentHash& add_bytes(const void* bytes, size_t size)
    {
        XXH3_128bits_update(state_.get(), bytes, size);
        return *this;
    }

    XXH128_hash_t digest() const { return XXH3_128bits_digest(state_.get()); }

    /// Returns 32 hexadecimal digits.
    std::string hex() const
    {
        const XXH128_hash_t hash = digest();
        return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
    }

private:
    std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

} // namespace ssrlab
