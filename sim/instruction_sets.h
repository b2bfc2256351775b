// Which instruction set the hot loops use: the best that the machine has, or less on request.
//
// Those loops are written with Highway: compiled for several sets, chosen when the program runs. They use no
// fused multiply-add and sum over fixed lanes, so that every set gives the same bits. Embree chooses for
// itself, under the same cap; which of two triangles it names on their common edge depends on its choice.
#pragma once

#include <string>
#include <vector>

namespace laterna {

/// The names that cap_instruction_set() knows on this kind of machine, narrowest first: sse2, sse4.2, avx,
/// avx2, avx512; neon on arm64; else scalar.
std::vector<std::string> instruction_set_names();

/// Uses no more than the named set from now on; "" lifts the cap. A set that the machine lacks caps nothing.
/// Not while other threads run; a RayScene keeps what held when it was made. Throws InputError for an unknown
/// name, listing the known ones.
void cap_instruction_set(const std::string& name);

/// The name of the set that the hot loops use (avx is served by sse4.2).
std::string instruction_set();

/// The cap in the words of rtcNewDevice(); with plain threads (sim/parallel.cpp) Embree gets one.
std::string embree_configuration();

}  // namespace laterna
