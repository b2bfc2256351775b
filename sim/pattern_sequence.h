// Pattern families: what a projector shows so that each of its pixels tells its own place.
//
// A coded sequence is a list of groups of pictures that change along one axis only, columns first, then rows,
// then all white and all black. A group is a *pair* (one bit of a code and its inverse) or a *fringe* (one
// sinusoid, shifted step by step). Encoder and decoder both read this list.
//
//   family           groups per axis
//   gray             a pair for each bit of the reflected binary code (sim/pattern.h)
//   xor_gray         the same bits, each but one exclusive-or'ed with the bit whose stripes are
//                    `xor_stripe_px` wide, so that no picture has wide stripes. Gupta, Agrawal, Veeraraghavan
//                    and Narasimhan, "Structured light 3D scanning in the presence of global illumination",
//                    CVPR 2011
//   gray_phase       Gray pairs for stripes of half a pitch, then one fringe of `steps` pictures
//   phase            a fringe of `pitch_px` and one whose single period spans the projector
//   multi_frequency  a fringe for each of `pitches_px`, unwrapped together
//   micro_phase      `pitches_px` in a narrow band: the first with `steps` pictures, the others with one
//                    each. Gupta and Nayar, "Micro phase shifting", CVPR 2012
//
// Any of them may show its first picture once more at the end, after black: where rig and scene stood still,
// both photographs are equal within the noise.
//
// A board (chessboard, charuco) is one picture, then white and black (sim/pattern_board.h). A slide and
// pictures come from files and tell no pixel its place.
#pragma once

#include "sim/pattern.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace laterna {

enum class PatternKind {
  gray,
  slide,
  gray_phase,
  phase,
  multi_frequency,
  micro_phase,
  xor_gray,
  chessboard,
  charuco,
  pictures
};

/// What the projectors show, whatever their size. Each family reads only what its line above names.
struct PatternParameters {
  PatternKind kind = PatternKind::gray;
  int steps = 4;                     ///< pictures of a fringe: 3 to 64
  double pitch_px = 32;              ///< one period; of phase families without `pitches_px`, the finest
  std::vector<double> pitches_px{};  ///< periods; empty: default_pitches_px()
  int xor_stripe_px = 2;             ///< a power of two, 2 to 1024
  int square_px = 64;                ///< side of a board's square, 8 to 4096
  bool repeat_first = false;         ///< coded families only
  bool operator==(const PatternParameters&) const = default;
};

struct PatternSequence {
  PatternParameters parameters{};
  glm::ivec2 projector_size{0, 0};  ///< 1 to 16384 pixels each way
};

/// Pictures that belong together: picture first + j is the j-th of the group.
struct PatternGroup {
  enum class Kind { pair, fringe } kind = Kind::pair;
  int axis = 0;  ///< 0: changes along columns, 1: along rows
  int first = 0, count = 0;
  int bit = 0;          ///< pair: 0 is the least significant
  double pitch_px = 0;  ///< fringe
};

/// Whether pictures of the family tell each pixel its place through groups; boards and files do not.
bool is_coded(PatternKind kind);

/// A slide or pictures.
bool comes_from_files(PatternKind kind);

/// Throws InputError, beginning with "patterns: ", where a number is out of its range, there are more than
/// 512 pictures, pitches cannot tell all columns or rows apart (as when all divide a length inside the
/// projector), or a board has fewer than 3×3 squares. A slide or pictures are not looked at.
void validate(const PatternSequence& sequence);

/// The groups of a coded sequence in the order of their pictures; empty for the others.
std::vector<PatternGroup> pattern_groups(const PatternSequence& sequence);

/// With white and black, which are the last two unless the first picture is repeated after them. Throws
/// InputError for a slide and for pictures.
int picture_count(const PatternSequence& sequence);

/// The index of the white picture; black is the next. Throws as picture_count() does.
int white_picture(const PatternSequence& sequence);

/// For people: "column bit 9 inverse", "row fringe of 32 px, step 2", "board", "white", "black", and
/// "column bit 9 again" of a repeated picture.
std::string picture_name(const PatternSequence& sequence, int k);

/// Picture k, 0 to 255 per projector pixel. A fringe shows round(127.5·(1 + cos(2π·x/pitch + 2π·j/steps))),
/// halves up, in its step j at column (or row) x. Throws InputError for k out of range, and as validate()
/// does.
Image<std::uint8_t> pattern_picture(const PatternSequence& sequence, int k);

/// The whole sequence: equal to pattern_picture for each k.
PatternStack make_pattern_stack(const PatternSequence& sequence);

/// Whether all pictures are black and white unions of columns and rows, at most 64: Gray and XOR codes.
bool is_binary(const PatternSequence& sequence);

/// Equal to pattern_picture for each k. Throws InputError where the sequence is not binary.
BinaryPatternStack make_binary_pattern_stack(const PatternSequence& sequence);

/// The pairs of an axis show the bits of this word at column or row x: the Gray code of x, or of the stripe
/// that x is in (gray_phase), with the exclusive or of xor_gray.
std::uint32_t code_word(const PatternSequence& sequence, int axis, int x);

/// How words become stripes: stripe = binary_from_gray(word ^ (bit `base` of word ? mask : 0)).
struct WordCode {
  int bits = 0;            ///< of a word
  int base = 0;            ///< a mask of 0: none
  std::uint32_t mask = 0;  ///< never holds bit `base`
  int stripes = 0;         ///< stripes that exist; larger results are no pixel of the projector
  double stripe_px = 1;    ///< stripe i is [i·stripe_px - 0.5, (i + 1)·stripe_px - 0.5)
};
WordCode word_code(const PatternSequence& sequence, int axis);

/// The periods of the fringes of an axis: pitches_px (multi_frequency: finest first), or what the family
/// takes without them. phase: {pitch, size + pitch}. multi_frequency: pitch, then growing at most 8-fold to
/// size + pitch. micro_phase: pitch, then five within 12 % of it.
std::vector<double> fringe_pitches_px(const PatternParameters& parameters, int size_px);

/// The least distance, over places whole first periods apart, between the fringe values that tell them apart,
/// in units of the modulation: sqrt(Σ_j (cos φ_j(x) - cos φ_j(x'))²) over all other pictures. Noise of σ/B of
/// a tenth of it confuses places rarely. validate() refuses less than 0.1.
double least_fringe_distance(const PatternParameters& parameters, int size_px);

}  // namespace laterna
