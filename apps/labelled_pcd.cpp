#include "labelled_pcd.h"

#include <cstring>

namespace pcl_surflet {
namespace apps {

std::string
asPcd(const SurfletSet& set, const PointLabels* labels)
{
  const std::string n = std::to_string(set.size());
  const bool labelled = labels != nullptr;
  std::string text = std::string("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n") +
                     "FIELDS x y z normal_x normal_y normal_z" +
                     (labelled ? " label instance" : "") + "\nSIZE 4 4 4 4 4 4" +
                     (labelled ? " 4 4" : "") + "\nTYPE F F F F F F" + (labelled ? " U U" : "") +
                     "\nCOUNT 1 1 1 1 1 1" + (labelled ? " 1 1" : "") + "\nWIDTH " + n +
                     "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
  const auto append = [&text](const auto& value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    text.append(bytes, sizeof value);
  };
  text.reserve(text.size() + set.size() * (labelled ? 32 : 24));
  for (std::size_t i = 0; i < set.size(); ++i) {
    append(set[i]); // six floats
    if (labelled) {
      append(labels->labels[i]);
      append(labels->instances[i]);
    }
  }
  return text;
}

} // namespace apps
} // namespace pcl_surflet
