/** \file
 * Our recognisers as the experiments try them. */
#pragma once

#include "experiment/recogniser.h"
#include "pcl_surflet/recognition/model_database.h"

namespace pcl_surflet {
namespace apps {

/** \brief The criteria of Table 3.1, in its order. */
const std::vector<Criterion>& tableCriteria();

/** \brief One model an object by training A: five even samplings of the mesh, all pairs. */
ModelDatabase trainObjects(const Training& training, const Resolution& resolution = {});

/** \brief One model an object with a member for every condition of ModelBank::standard(). */
ModelDatabase trainBanks(const Training& training);

/** \brief The likelihood by trainBanks(), named "bank". */
std::unique_ptr<Recogniser> bankRecogniser(const Training& training);

/** \brief The six criteria as the dissertation ran them: 0.005 % of a query's pairs drawn
 * [Wahl 2007, Sec. 3.6.2], empty bins as full as the rarest (Eq. 3.20 with tau = 1). And
 * Kullback-Leibler without the bins that the query left empty. */
Recognisers dissertationCriteria(const ModelDatabase& database);

/** \brief The same seven with HistogramClassifier's defaults: 2,000 features, floor 1e-5. */
Recognisers defaultCriteria(const ModelDatabase& database);

/** \brief The likelihood with the defaults, named \p name. */
std::unique_ptr<Recogniser> likelihoodRecogniser(const std::string& name,
                                                 const ModelDatabase& database);

/** \brief What we set against PCL's descriptors. */
Recognisers ours(const Training& training);

} // namespace apps
} // namespace pcl_surflet
