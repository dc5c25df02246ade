// SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGPIPE request a stop; a second one ends the program at once.
#pragma once

namespace ssrlab {

/// From now on the first of these signals is only noted, and a write beyond a file size limit is an error.
void listen_for_stop();

/// Returns the signal that requested a stop, or 0.
int stop_requested();

} // namespace ssrlab
