#include "experiment/chapter3.h"
#include "experiment/chapter3/settings.h"
#include "experiment/gallery.h"
#include "experiment/plots.h"
#include "experiment/surflet_recognisers.h"
#include "pcl_surflet/database_file.h"

#include <cstdio>

namespace pcl_surflet {
namespace apps {
namespace {

std::string
drawCriteria(const Rates& rates, const std::string& directory)
{
  std::vector<ConfusionPicture> pictures;
  for (std::size_t r = 0; r < tableCriteria().size(); ++r) {
    const Tally& t = rates.tallies.front()[r];
    pictures.push_back({rates.recognisers[r]->name(), {}});
    for (const auto& row : t.confusion) {
      pictures.back().rates.emplace_back();
      for (const auto count : row)
        pictures.back().rates.back().push_back(static_cast<double>(count) /
                                               static_cast<double>(t.tests_of.front()));
    }
  }
  return drawConfusions(directory, "criteria_confusion", pictures, 3);
}

} // namespace

int
runClassification(const ChapterOptions& options)
{
  ModelDatabase database;
  const auto train = [&](const Training& training) {
    database = trainObjects(training);
    saveDatabase(database, options.rates.out + "/objects.pcd");
    Recognisers all;
    all.push_back(likelihoodRecogniser("likelihood", database));
    return all;
  };
  const auto draw = [&](const Rates& rates, const std::string& directory) {
    return drawGallery(rates.objects, database, directory);
  };
  const int code = reportRates(
      {"classification", "Likelihood criterion, resolution 5,5,5,5: ideal, noise, visibility",
       classificationSettings(), train, draw},
      options.rates);
  std::printf("wrote objects.pcd (the database)\n");
  return code;
}

int
runCriteria(const ChapterOptions& options)
{
  const auto train = [](const Training& training) {
    const ModelDatabase database = trainObjects(training);
    Recognisers all = dissertationCriteria(database);
    for (auto& recogniser : defaultCriteria(database))
      all.push_back(std::move(recogniser));
    return all;
  };
  return reportRates({"criteria",
                      "Table 3.1, Fig. 3.4: six criteria under ideal conditions",
                      {fixedSetting("ideal", 0, {})},
                      train,
                      drawCriteria},
                     options.rates);
}

} // namespace apps
} // namespace pcl_surflet
