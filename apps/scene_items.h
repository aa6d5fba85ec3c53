/** \file
 * Options of the programs that make scenes. */
#pragma once

#include "app_common.h"

#include "pcl_surflet/core/scene_generator.h"

#include <string>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief \p text cut at every \p separator. */
std::vector<std::string> parts(const std::string& text, char separator);

/** \brief Items given as SHAPE or FILE[:DIAMETER[:UP]]. \throws UsageError, DataError */
std::vector<SceneItem> itemsOf(const std::vector<std::string>& texts);

/** \brief Writes what itemsOf() makes of \p texts, as meshes in the scene's unit with z up:
 * \p directory / NAME.off. The directory is made if need be. \throws UsageError, DataError,
 * MeshFileError */
void saveMeshes(const std::vector<std::string>& texts, const std::string& directory);

/** \brief An option that takes one of some names. */
template <class Value>
void
addChoice(CommandLine& line, const std::string& name, const std::string& help, Value& target,
          const std::vector<std::pair<std::string, Value>>& choices)
{
  std::string names;
  for (const auto& choice : choices)
    names += (names.empty() ? "" : ", ") + choice.first;
  line.option(name, "NAME", help + ": " + names, [=, &target](const std::string& text) {
    for (const auto& choice : choices)
      if (choice.first == text) {
        target = choice.second;
        return;
      }
    throw UsageError("option " + name + ": there is no '" + text + "'; the names are " + names);
  });
}

/** \brief Background, posture and distances. \p target holds the defaults. */
void addArrangement(CommandLine& line, SceneOptions& target);

} // namespace apps
} // namespace pcl_surflet
