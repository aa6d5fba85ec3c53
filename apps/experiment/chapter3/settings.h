/** \file
 * The conditions that the experiments of chapter 3 are made of. */
#pragma once

#include "experiment/trials.h"

#include <functional>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Noise along the normals, a share of the diameter; \p normal_radius in spacings. */
Condition noisy(double share, double normal_radius = Condition().normal_radius);
/** \brief That share of the surface left by a random plane. */
Condition cut(double visible);
/** \brief Training spacing / query spacing. */
Condition sampled(double resolution);

/** \brief Conditions of doc/classification.md. */
std::vector<Setting> classificationSettings();

/** \brief Those and half resolution: by these the peers choose their metric. */
std::vector<Setting> choosingSettings();

/** \brief Those, levels that no model was trained with, and several things at once: the table
 * against the peers. New ones go to the end, so that the others keep their queries. */
std::vector<Setting> peerSettings();

/** \brief Settings of one condition at each of \p percents; \p condition is given the share. */
std::vector<Setting> settingsAt(const std::vector<double>& percents, const std::string& what,
                                const std::function<Condition(double share)>& condition);

} // namespace apps
} // namespace pcl_surflet
