// The text of a model bank: what is taken lies in the ranges and is written as it would be read
// again; what is refused must be a ModelBankError that names the line.
#include "pcl_surflet/recognition/model_bank.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>

using namespace pcl_surflet;

namespace {

bool
isInRange(const BankCondition& c)
{
  return c.noise >= 0 && c.noise <= 0.5 && c.visible > 0 && c.visible <= 1 && c.members >= 1 &&
         c.members <= BankCondition::kMostMembers && c.name(c.members - 1, c.members).size() < 64;
}

} // namespace

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  try {
    const ModelBank bank = ModelBank::parse(std::string(data, data + size));
    for (const auto& condition : bank.conditions)
      if (!isInRange(condition))
        std::abort();
    const std::string text = bank.toText();
    if (ModelBank::parse(text).toText() != text)
      std::abort();
  }
  catch (const ModelBankError& error) {
    if (std::strncmp(error.what(), "line ", 5) != 0)
      std::abort();
  }
  return 0;
}
