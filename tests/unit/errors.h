// What a call is refused with.
#pragma once

#include "test.h"

namespace ssrlab {

/// What the Error says that the call throws.
template <typename Error, typename Call> std::string message_of(const Call& call)
{
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "(no such error)";
}

} // namespace ssrlab
