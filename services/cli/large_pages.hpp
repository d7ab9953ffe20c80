#pragma once

namespace fathom::cli {

/// For commands that hold a whole recording: the heap grows in large steps, in large pages of the kernel
/// where it has them (transparent huge pages), and keeps what is freed. The first touch of a page costs up to
/// 10 us, and 50 MB are 12,000 pages of 4 kB. Nothing that is computed depends on it. Call it before other
/// threads begin. Does nothing with other C libraries than glibc.
void use_large_pages();

}  // namespace fathom::cli
