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

/** \brief Which things are in a scene, given on the command line. */
struct SceneContents {
  std::string clutter; ///< items, by commas
  std::uint64_t present = 0, unknown = 0;
};

/** \brief -clutter, -unknown. */
void addClutter(CommandLine& line, SceneContents& target);

/** \brief -present, and addClutter(). */
void addContents(CommandLine& line, SceneContents& target);

/** \brief The items of -clutter, if it was given. \throws UsageError, DataError */
std::vector<SceneItem> clutterOf(const CommandLine& line, const SceneContents& contents);

/** \brief Takes over how many of so many objects and things of the clutter are present, by default
 * all. \throws UsageError if there are not so many */
void settleContents(const CommandLine& line, const SceneContents& contents, std::size_t objects,
                    std::size_t clutter, SceneOptions& target);

/** \brief Writes what itemsOf() makes of \p texts, as meshes in the scene's unit with z up:
 * \p directory / NAME.off. The directory is made if need be. \throws UsageError, DataError,
 * MeshFileError */
void saveMeshes(const std::vector<std::string>& texts, const std::string& directory);

/** \brief Labels of the items, in their order. */
std::vector<std::string> labelsOf(const std::vector<SceneItem>& items);

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

/** \brief An option that takes some of \p known names. */
void addNames(CommandLine& line, const std::string& option, const std::string& help,
              const std::vector<std::string>& known, std::vector<std::string>& target);

/** \brief An option that takes several numbers, each in [\p low, \p high]. \param value what the
 * help calls them */
void addNumbers(CommandLine& line, const std::string& option, const std::string& value,
                const std::string& help, double low, double high, std::vector<double>& target);

/** \brief Background, posture, distances, density and noise. \p target holds the defaults. */
void addArrangement(CommandLine& line, SceneOptions& target);

} // namespace apps
} // namespace pcl_surflet
