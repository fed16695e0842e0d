#include "core/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"

namespace {

using namespace squall;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SettingsText, ReadsBackWhatItWrites) {
  for (const Pressure choice : {Pressure::mueller, Pressure::wcsph, Pressure::dfsph})
    EXPECT_EQ(pressure_from_text(to_string(choice)), choice);
  for (const Precision choice : {Precision::single_precision, Precision::double_precision})
    EXPECT_EQ(precision_from_text(to_string(choice)), choice);
  for (const Simd choice : {Simd::best, Simd::scalar, Simd::avx2, Simd::avx512})
    EXPECT_EQ(simd_from_text(to_string(choice)), choice);
  for (const Readback choice :
       {Readback::none, Readback::blocking, Readback::pinned, Readback::mapped, Readback::async, Readback::quantized})
    EXPECT_EQ(readback_from_text(to_string(choice)), choice);
}

TEST(SettingsText, ListsTheValidNamesForAnyOther) {
  EXPECT_THAT([] { pressure_from_text("sph"); },
              ThrowsMessage<InputError>("pressure 'sph' is not known; valid names: mueller, wcsph, dfsph"));
  EXPECT_THAT([] { precision_from_text(""); },
              ThrowsMessage<InputError>("precision '' is not known; valid names: single, double"));
  EXPECT_THAT([] { readback_from_text("fast"); },
              ThrowsMessage<InputError>(HasSubstr("none, blocking, pinned, mapped, async, quantized")));
  EXPECT_THAT([] { simd_from_text("AVX2"); }, ThrowsMessage<InputError>(HasSubstr("scalar, avx2, avx512")));
}

}  // namespace
