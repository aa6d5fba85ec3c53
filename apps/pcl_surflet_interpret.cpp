// What is where in a scene?

#include "app_common.h"
#include "interpretation/options.h"
#include "interpretation/output.h"
#include "interpretation/scene_worker.h"
#include "interpretation/text.h"
#include "parallel/share_out.h"

#include <iostream>
#include <optional>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_interpret";

/** \brief Goes on after a file that cannot be used. \return exit code */
int
interpretAll(SceneWorker& worker, const InterpretOptions& o, Ranks& ranks)
{
  int code = kOk;
  if (o.csv && ranks.isFirst())
    std::cout << csvHeader(!o.pose.models.empty());
  shareOut<InterpretedScene>(
      ranks, o.files.size(), [&](std::size_t i) { return worker.interpret(o.files[i]); },
      [&](std::size_t i, const InterpretedScene& scene) {
        try {
          deliver(scene, o);
        }
        catch (const std::exception& error) {
          complain(std::string(kProgram) + ": " + about(o.files[i], error.what()));
          code = kBadData;
        }
      });
  return code;
}

int
interpret(int argc, char** argv, Ranks& ranks)
{
  InterpretOptions o;
  bool help = false;
  ranks.together([&] { help = !readInterpretOptions(kProgram, argc, argv, o); });
  if (help)
    return kOk;
  o.threads = ranks.threads(o.threads);
  std::optional<SceneWorker> worker;
  std::vector<std::string> notes;
  ranks.together([&] {
    for (const auto& path : {o.out, o.picture})
      checkOutput(path);
    o.pose.load();
    worker.emplace(readDatabase(o.database), o, notes);
  });
  if (ranks.isFirst())
    for (const auto& text : notes)
      note(text);
  return interpretAll(*worker, o, ranks);
}

} // namespace

int
main(int argc, char** argv)
{
  return runOnRanks(kProgram, argc, argv,
                    [&](Ranks& ranks) { return interpret(argc, argv, ranks); });
}
