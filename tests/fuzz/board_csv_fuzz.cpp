// Sightings that are accepted are written and read back.
#include "calib/boards/correspondence_csv.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const glm::ivec2 size(640, 480);
    const BoardCapture capture =
        parse_correspondence_csv(fuzz::text_of(bytes, count), "fuzz.csv", size, size);
    const std::string text = correspondence_csv(capture);
    fuzz::expect(correspondence_csv(parse_correspondence_csv(text, "again.csv", size, size)) == text,
                 "write(parse(text)) is the text");
  });
}
