#include "experiment/surflet_recognisers.h"

#include "experiment/samples.h"
#include "pcl_surflet/model_bank_trainer.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Share of all pairs of a query that the dissertation draws. */
constexpr double kShareOfPairs = 5e-5;

constexpr const char *kByDefaults = ", defaults", *kFilledBins = "kullback, filled bins";

HistogramClassifier
classifierOf(const ModelDatabase& database, Criterion criterion)
{
  HistogramClassifier classifier(database);
  classifier.setCriterion(criterion);
  return classifier;
}

/** \brief How many features to draw from \p query: a share of all its pairs, or \p otherwise if the
 * share is 0. */
std::uint64_t
featuresOf(const SurfletSet& query, double share_of_pairs, std::uint64_t otherwise)
{
  if (share_of_pairs == 0)
    return otherwise;
  const auto m = static_cast<double>(query.size());
  return static_cast<std::uint64_t>(std::max(1.0, share_of_pairs * m * (m - 1) / 2));
}

class HistogramRecogniser : public Recogniser {
public:
  /** \param share_of_pairs how many features to draw; 0: the classifier's default */
  HistogramRecogniser(const std::string& name, HistogramClassifier classifier,
                      double share_of_pairs = 0, Normals normals = Normals::Sampled)
      : Recogniser(name, normals), classifier_(std::move(classifier)),
        share_of_pairs_(share_of_pairs)
  {
  }

  Answer
  classify(const SurfletSet& query) const override
  {
    if (share_of_pairs_ == 0)
      return timed(classifier_, query);
    HistogramClassifier classifier = classifier_;
    classifier.setNumberOfFeatures(featuresOf(query, share_of_pairs_, 0));
    return timed(classifier, query);
  }

private:
  static Answer
  timed(const HistogramClassifier& classifier, const SurfletSet& query)
  {
    const double start = threadSeconds();
    const auto result = classifier.classify(query);
    Answer answer;
    answer.seconds = threadSeconds() - start;
    answer.failed = result.ranking.empty();
    if (!answer.failed)
      answer.object = result.ranking.front().model;
    return answer;
  }

  HistogramClassifier classifier_;
  double share_of_pairs_;
};

/** \brief Kullback-Leibler over the bins that the query fills: the other reading of Eq. 3.14 where
 * Q is zero. The library's takes the limit of Q ln Q and floors ln Q. */
class KullbackOfFilledBins : public Recogniser {
public:
  KullbackOfFilledBins(const std::string& name, const ModelDatabase& database,
                       double share_of_pairs)
      : Recogniser(name), share_of_pairs_(share_of_pairs), members_(database.penalized()),
        resolution_(database.resolution()), h_min_(database.penaltyMinimum()),
        features_(HistogramClassifier(database).getNumberOfFeatures())
  {
    for (std::size_t i = 0; i < database.size(); ++i)
      delta_max_.push_back(database[i].delta_max);
  }

  Answer
  classify(const SurfletSet& query) const override
  {
    const double start = threadSeconds();
    const auto sample = drawFeatures(PairSource(query), resolution_,
                                     featuresOf(query, share_of_pairs_, features_), 1, 1);
    Answer answer;
    double best = 0;
    for (const auto& member : members_) {
      const double d = sample.size() > 0 ? divergence(member, sample) : 0;
      if (answer.object == Answer::kNone || d < best) {
        best = d;
        answer.object = member.model;
      }
    }
    answer.seconds = threadSeconds() - start;
    return answer;
  }

private:
  double
  divergence(const PenalizedHistogram& member, const FeatureSample& sample) const
  {
    std::vector<std::uint32_t> bins;
    sample.bins(delta_max_[member.model], bins);
    Histogram q(member.h.size(), 0.0), h = member.h;
    for (const auto b : bins)
      q[b] += 1.0 / static_cast<double>(bins.size());
    for (std::size_t b = 0; b < q.size(); ++b)
      if (q[b] == 0)
        h[b] = h_min_; // contributes h_min ln (h_min / h_min) = 0
    return kullbackLeibler(h, q, h_min_);
  }

  double share_of_pairs_;
  std::vector<PenalizedHistogram> members_;
  std::vector<double> delta_max_;
  Resolution resolution_;
  double h_min_;
  std::uint64_t features_;
};

/** \brief One model an object from the very samples and normals that the peers are trained with. */
ModelDatabase
trainOnSamples(const Training& training)
{
  HistogramModelTrainer trainer;
  trainer.setSeed(training.seed);
  trainer.setNumberOfThreads(training.threads);
  ModelDatabase database;
  for (std::size_t o = 0; o < training.objects.size(); ++o) {
    training.progress(o, "samples of " + training.objects[o].label);
    SurfletSet all;
    for (const auto& sample : unturnedSamples(training.objects[o], trainingSeed(training.seed, o)))
      for (std::size_t i = 0; i < sample.size(); ++i)
        all.push_back(sample[i]);
    database.add(trainer.train(training.objects[o].label, all));
  }
  return database;
}

HistogramModelTrainer
meshTrainer(const Training& training, const Resolution& resolution)
{
  HistogramModelTrainer trainer;
  trainer.setResolution(resolution);
  trainer.setSeed(training.seed);
  trainer.setNumberOfThreads(training.threads);
  trainer.setMeshSampling(kMeshSurflets, kTrainingRounds);
  return trainer;
}

template <class Trainer>
ModelDatabase
trainedBy(const Trainer& trainer, const Training& training)
{
  ModelDatabase database;
  for (std::size_t i = 0; i < training.objects.size(); ++i) {
    training.progress(i, "training " + training.objects[i].label);
    database.add(trainer.train(training.objects[i].label, training.objects[i].mesh));
  }
  return database;
}

} // namespace

const std::vector<Criterion>&
tableCriteria()
{
  static const std::vector<Criterion> criteria = {
      Criterion::Intersection, Criterion::SquaredEuclidean, Criterion::ChiSquared1,
      Criterion::ChiSquared2,  Criterion::KullbackLeibler,  Criterion::Likelihood};
  return criteria;
}

ModelDatabase
trainObjects(const Training& training, const Resolution& resolution)
{
  return trainedBy(meshTrainer(training, resolution), training);
}

ModelDatabase
trainBanks(const Training& training)
{
  return trainedBy(ModelBankTrainer(meshTrainer(training, {}), ModelBank::standard()), training);
}

std::unique_ptr<Recogniser>
bankRecogniser(const Training& training)
{
  return likelihoodRecogniser("bank", trainBanks(training));
}

Recognisers
dissertationCriteria(const ModelDatabase& database)
{
  ModelDatabase strict = database;
  strict.setPenalty({1.0, 0.0});
  Recognisers all;
  for (const Criterion c : tableCriteria())
    all.push_back(std::make_unique<HistogramRecogniser>(criterionName(c), classifierOf(strict, c),
                                                        kShareOfPairs));
  all.push_back(std::make_unique<KullbackOfFilledBins>(kFilledBins, strict, kShareOfPairs));
  return all;
}

Recognisers
defaultCriteria(const ModelDatabase& database)
{
  Recognisers all;
  for (const Criterion c : tableCriteria())
    all.push_back(std::make_unique<HistogramRecogniser>(criterionName(c) + std::string(kByDefaults),
                                                        classifierOf(database, c)));
  all.push_back(
      std::make_unique<KullbackOfFilledBins>(kFilledBins + std::string(kByDefaults), database, 0));
  return all;
}

std::unique_ptr<Recogniser>
likelihoodRecogniser(const std::string& name, const ModelDatabase& database)
{
  return std::make_unique<HistogramRecogniser>(name, classifierOf(database, Criterion::Likelihood));
}

Recognisers
ours(const Training& training)
{
  Recognisers all;
  all.push_back(bankRecogniser(training));
  for (auto& clean : defaultCriteria(trainObjects(training)))
    all.push_back(std::move(clean));
  all.push_back(std::make_unique<HistogramRecogniser>(
      "likelihood, peers' data", classifierOf(trainOnSamples(training), Criterion::Likelihood), 0,
      Normals::Estimated));
  return all;
}

} // namespace apps
} // namespace pcl_surflet
