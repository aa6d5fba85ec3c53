#include "experiment/peers/peer_recognisers.h"

#include "experiment/peers/isolation.h"
#include "experiment/peers/nearest_signature.h"
#include "experiment/samples.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Further training samples per object and setting by which the metric is chosen. */
constexpr std::size_t kChoosingSamples = 2;

struct Described {
  Signatures signatures; ///< empty after a failure
  double seconds = 0;
};

/** \brief PCL leaves NaN in the signatures of some clouds, and FLANN would call them nearest. */
void
dropUnusable(Signatures& signatures)
{
  const auto unusable = [](const std::vector<float>& s) {
    return !std::all_of(s.begin(), s.end(), [](float v) { return std::isfinite(v); });
  };
  signatures.erase(std::remove_if(signatures.begin(), signatures.end(), unusable),
                   signatures.end());
}

Described
describe(const PeerDescriptor& descriptor, const SurfletSet& surflets)
{
  const PeerCloud cloud = toPeerCloud(surflets);
  Described out;
  if (descriptor.isolated) {
    if (auto result = runIsolated([&] { return descriptor.compute(cloud); }))
      out = {std::move(result->signatures), result->seconds};
  }
  else {
    const double start = threadSeconds();
    out.signatures = descriptor.compute(cloud);
    out.seconds = threadSeconds() - start;
  }
  dropUnusable(out.signatures);
  return out;
}

class PeerRecogniser : public Recogniser {
public:
  PeerRecogniser(const PeerDescriptor& descriptor, Metric metric, NearestSignature nearest)
      : Recogniser(descriptor.name + ", " + metricName(metric), Normals::Estimated),
        descriptor_(descriptor), nearest_(std::move(nearest))
  {
  }

  Answer
  classify(const SurfletSet& query) const override
  {
    const Described described = describe(descriptor_, query);
    Answer answer;
    answer.seconds = described.seconds;
    answer.failed = described.signatures.empty();
    if (answer.failed)
      return answer;
    const double start = threadSeconds();
    answer.object = nearest_.object(described.signatures);
    answer.seconds += threadSeconds() - start;
    return answer;
  }

private:
  const PeerDescriptor& descriptor_;
  NearestSignature nearest_;
};

/** \brief Clouds with the numbers of their objects. */
struct LabelledClouds {
  std::vector<SurfletSet> clouds;
  std::vector<std::size_t> objects;
};

/** \brief The samples that are remembered. */
LabelledClouds
trainingClouds(const Training& training)
{
  LabelledClouds out;
  for (std::size_t o = 0; o < training.objects.size(); ++o) {
    const auto seed = trainingSeed(training.seed, o);
    for (const auto& sample : unturnedSamples(training.objects[o], seed)) {
      out.clouds.push_back(randomlyRotated(sample, mix64(seed + out.clouds.size())));
      out.objects.push_back(o);
    }
  }
  return out;
}

/** \brief The samples by which the metric is chosen. */
LabelledClouds
choosingClouds(const Training& training, const std::vector<Setting>& settings)
{
  LabelledClouds out;
  for (std::size_t o = 0; o < training.objects.size(); ++o)
    for (std::size_t s = 0; s < settings.size(); ++s)
      for (std::size_t k = 0; k < kChoosingSamples; ++k) {
        const auto seed = mix64(trainingSeed(training.seed, o) + 1 + s) + k;
        if (const auto condition = settings[s].condition(seed)) {
          out.clouds.push_back(makeQuery(training.objects[o], *condition, seed, true).estimated);
          out.objects.push_back(o);
        }
      }
  return out;
}

std::vector<Signatures>
describeAll(const PeerDescriptor& descriptor, const LabelledClouds& data, unsigned threads)
{
  std::vector<Signatures> all(data.clouds.size());
  parallelFor(all.size(), threads, [&](std::size_t i, unsigned) {
    all[i] = describe(descriptor, data.clouds[i]).signatures;
  });
  return all;
}

std::unique_ptr<Recogniser>
trainPeer(const PeerDescriptor& descriptor, const LabelledClouds& remembered,
          const LabelledClouds& choosing, unsigned threads)
{
  const auto known = describeAll(descriptor, remembered, threads);
  if (std::all_of(known.begin(), known.end(), [](const auto& s) { return s.empty(); }))
    throw DataError(descriptor.name + " describes none of the training samples; leave it out");
  const auto asked = describeAll(descriptor, choosing, threads);
  Metric best = allMetrics().front();
  std::size_t most = 0;
  for (const Metric metric : allMetrics()) {
    const NearestSignature nearest(known, remembered.objects, metric);
    std::size_t right = 0;
    for (std::size_t i = 0; i < asked.size(); ++i)
      right += !asked[i].empty() && nearest.object(asked[i]) == choosing.objects[i];
    if (right > most) {
      most = right;
      best = metric;
    }
  }
  return std::make_unique<PeerRecogniser>(descriptor, best,
                                          NearestSignature(known, remembered.objects, best));
}

const PeerDescriptor&
descriptorNamed(const std::string& name)
{
  for (const auto& descriptor : peerDescriptors())
    if (descriptor.name == name)
      return descriptor;
  throw UsageError("option -peers: there is no '" + name + "'; known: " + peerNames());
}

} // namespace

std::string
peerNames()
{
  std::string names;
  for (const auto& descriptor : peerDescriptors())
    names += (names.empty() ? "" : ",") + descriptor.name;
  return names;
}

void
requirePeers(const std::vector<std::string>& names)
{
  for (const auto& name : names)
    descriptorNamed(name);
}

Recognisers
peers(const Training& training, const std::vector<std::string>& names,
      const std::vector<Setting>& settings)
{
  std::vector<const PeerDescriptor*> wanted;
  wanted.reserve(names.size());
  for (const auto& name : names)
    wanted.push_back(&descriptorNamed(name));
  training.progress(0, "training samples of the peers");
  const auto remembered = trainingClouds(training);
  const auto choosing = choosingClouds(training, settings);
  Recognisers all;
  for (const auto* descriptor : wanted) {
    training.progress(0, "training " + descriptor->name);
    all.push_back(trainPeer(*descriptor, remembered, choosing, training.threads));
  }
  return all;
}

} // namespace apps
} // namespace pcl_surflet
