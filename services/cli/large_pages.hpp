#pragma once

namespace fathom::cli {

/// For commands that hold a whole recording. The heap grows in steps of 256 MB, keeps what is freed, and has
/// its first step in large pages of the kernel, where there are any (transparent huge pages): the first touch
/// of a page costs up to 10 us, and 50 MB are 12,000 pages of 4 kB. Nothing that is computed depends on it.
/// Call it before other threads begin. Does nothing with other C libraries than glibc.
void use_large_pages();

}  // namespace fathom::cli
