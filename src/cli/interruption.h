#pragma once

namespace ist::cli {

/// From now on SIGINT, SIGTERM and SIGHUP still end the process, by the signal itself, but no
/// unfinished file stays behind and no progress bar; and a file that grows beyond its limit
/// (SIGXFSZ) is an error like a full disk. To be called before there is any other thread.
void leave_nothing_half_done();

}  // namespace ist::cli
