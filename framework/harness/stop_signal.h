// SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGPIPE ask; asking twice ends the program at once.
#pragma once

namespace ssrlab {

/// From now on the first of these signals is only noted. A write beyond a file size limit becomes an error, not a death.
void listen_for_stop();

/// 0, or the signal that asked to stop.
int stop_requested();

} // namespace ssrlab
