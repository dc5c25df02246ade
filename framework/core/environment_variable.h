// A variable of the process's environment: what it was comes back at the end.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace ssrlab {

class EnvironmentVariable {
public:
    explicit EnvironmentVariable(const char* name) : name_(name)
    {
        if (const char* before = std::getenv(name)) before_ = before;
    }
    EnvironmentVariable(const char* name, const std::optional<std::string>& value) : EnvironmentVariable(name)
    {
        set(value);
    }
    ~EnvironmentVariable() { set(before_); }
    EnvironmentVariable(const EnvironmentVariable&)            = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

private:
    void set(const std::optional<std::string>& value)
    {
        if (value)
            ::setenv(name_, value->c_str(), 1);
        else
            ::unsetenv(name_);
    }

    const char*                name_;
    std::optional<std::string> before_;
};

} // namespace ssrlab
