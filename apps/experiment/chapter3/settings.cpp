#include "experiment/chapter3/settings.h"

#include "experiment/output.h"

namespace pcl_surflet {
namespace apps {

Condition
noisy(double share, double normal_radius)
{
  Condition c;
  c.noise = share;
  c.normal_radius = normal_radius;
  return c;
}

Condition
cut(double visible)
{
  Condition c;
  c.visible = visible;
  return c;
}

Condition
sampled(double resolution)
{
  Condition c;
  c.resolution = resolution;
  return c;
}

std::vector<Setting>
classificationSettings()
{
  std::vector<Setting> all = {fixedSetting("ideal", 0, {})};
  for (const int percent : {1, 2, 4})
    all.push_back(fixedSetting(formatted("noise %d %%", percent), percent, noisy(percent / 100.0)));
  for (const int percent : {65, 40, 25})
    all.push_back(fixedSetting(formatted("visible %d %%", percent), percent, cut(percent / 100.0)));
  return all;
}

std::vector<Setting>
choosingSettings()
{
  auto all = classificationSettings();
  all.push_back(fixedSetting("half resolution", 50, sampled(0.5)));
  return all;
}

std::vector<Setting>
peerSettings()
{
  auto all = choosingSettings();
  all.push_back(fixedSetting("noise 3 %", 3, noisy(0.03)));
  all.push_back(fixedSetting("visible 55 %", 55, cut(0.55)));
  Condition both = noisy(0.04);
  both.visible = 0.5;
  all.push_back(fixedSetting("noise 4 %, 50 %", 4, both));
  Condition view = noisy(0.003);
  view.view = true;
  all.push_back(fixedSetting("single view", 0.3, view));
  return all;
}

std::vector<Setting>
settingsAt(const std::vector<double>& percents, const std::string& what,
           const std::function<Condition(double share)>& condition)
{
  std::vector<Setting> all;
  all.reserve(percents.size());
  for (const double p : percents)
    all.push_back(fixedSetting(what + formatted(" %g %%", p), p, condition(p / 100)));
  return all;
}

} // namespace apps
} // namespace pcl_surflet
