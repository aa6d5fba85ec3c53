#include "experiment/chapter3.h"
#include "experiment/chapter3/settings.h"
#include "experiment/peers/peer_recognisers.h"
#include "experiment/surflet_recognisers.h"

#include <algorithm>
#include <iterator>

namespace pcl_surflet {
namespace apps {
namespace {

std::string
noPicture(const Rates&, const std::string&)
{
  return {};
}

} // namespace

int
runPeers(const ChapterOptions& options)
{
  requirePeers(options.peer_list);
  const auto train = [&](const Training& training) {
    auto all = peers(training, options.peer_list, choosingSettings());
    auto own = ours(training);
    std::move(all.begin(), all.end(), std::back_inserter(own));
    return own;
  };
  return reportRates(
      {"peers", "Ours beside PCL's global descriptors by 1-NN", peerSettings(), train, noPicture},
      options.rates);
}

} // namespace apps
} // namespace pcl_surflet
