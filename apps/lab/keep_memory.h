// What a process does with memory that it has freed.
#pragma once

namespace laterna {

/// Memory that is freed stays with the process, for good: work that takes and frees the same tens of
/// megabytes over and over, as samples of a data set do, is spared the kernel's clearing of each page. For a
/// program to call, not a library: it holds for all of the process. With glibc's allocator; elsewhere it does
/// nothing.
void keep_freed_memory();

}  // namespace laterna
