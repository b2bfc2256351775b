// Tracks that are accepted are written and read back.
#include "calib/selfcal/tracks.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const std::string text = tracks_text(parse_tracks(fuzz::text_of(bytes, count), "fuzz.csv"));
    fuzz::expect(tracks_text(parse_tracks(text, "again.csv")) == text, "write(parse(text)) is the text");
  });
}
