// The most memory that this process held since it was last asked to count.
#pragma once

namespace laterna {

/// Begins to count anew: writes 5 to /proc/self/clear_refs, which sets the peak to what is held now
/// (proc(5)). False where the system has no such file or refuses.
bool restart_peak_memory();

/// VmHWM of /proc/self/status, the greatest resident set since then, in MiB: whatever the process holds,
/// libraries and scenes at hand included. NaN where the system does not tell.
double peak_memory_mib();

}  // namespace laterna
