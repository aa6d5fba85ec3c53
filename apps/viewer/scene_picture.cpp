#include "scene_picture.h"

#include <pcl/common/common.h>
#include <pcl/visualization/pcl_visualizer.h>

#include <vtkBillboardTextActor3D.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

using Colour = std::array<double, 3>;

constexpr double kRadian = 3.14159265358979323846 / 180;
constexpr Colour kGrey{205, 207, 210};
constexpr std::array<Colour, 12> kPalette{{{31, 119, 180},
                                           {230, 110, 20},
                                           {44, 150, 60},
                                           {205, 45, 50},
                                           {140, 100, 190},
                                           {150, 95, 75},
                                           {225, 110, 185},
                                           {160, 160, 30},
                                           {20, 170, 190},
                                           {240, 170, 30},
                                           {90, 60, 140},
                                           {90, 140, 110}}};

Colour
colourOf(std::uint32_t label)
{
  return label == 0 ? kGrey : kPalette[(label - 1) % kPalette.size()];
}

/** \brief Where the eye is, seen from the scene. */
Eigen::Vector3d
eyeDirection(const PictureOptions& o)
{
  const double a = o.azimuth * kRadian, e = o.elevation * kRadian;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

/** \brief Share of the colour that a point shows: light falls from above, beside the eye. Without
 * normal all of it. */
double
brightness(const pcl::PointXYZLNormal& p, const Eigen::Vector3d& light)
{
  const Eigen::Vector3d n(p.normal_x, p.normal_y, p.normal_z);
  const double length = n.norm();
  if (!(length > 0) || !std::isfinite(length))
    return 1;
  return 0.35 + 0.65 * std::max(0.0, n.dot(light) / length);
}

pcl::PointCloud<pcl::PointXYZRGB>::Ptr
coloured(const LabelledScene& scene, const PictureOptions& o)
{
  PictureOptions aside = o;
  aside.azimuth -= 35;
  aside.elevation = std::min(o.elevation + 25, 85.0);
  const Eigen::Vector3d light = eyeDirection(aside);
  pcl::PointCloud<pcl::PointXYZRGB>::Ptr out(new pcl::PointCloud<pcl::PointXYZRGB>);
  out->reserve(scene.points.size());
  for (const auto& p : scene.points) {
    const Colour c = colourOf(p.label);
    const double b = brightness(p, light);
    pcl::PointXYZRGB q(static_cast<std::uint8_t>(b * c[0]), static_cast<std::uint8_t>(b * c[1]),
                       static_cast<std::uint8_t>(b * c[2]));
    q.x = p.x;
    q.y = p.y;
    q.z = p.z;
    out->push_back(q);
  }
  return out;
}

/** \brief Right and up in the picture, to the eye. */
struct Directions {
  Eigen::Vector3d right, up, to_eye;

  explicit Directions(const PictureOptions& o)
      : right(Eigen::Vector3d::UnitZ().cross(eyeDirection(o)).normalized()),
        up(eyeDirection(o).cross(right)), to_eye(eyeDirection(o))
  {
  }
};

/** \brief A thing's name and where it is written: above the middle of what one sees of it. */
struct Caption {
  std::uint32_t label = 0;
  std::size_t points = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double top = 0; ///< along the picture's up
};

std::vector<Caption>
captionsOf(const LabelledScene& scene, const Eigen::Vector3d& up)
{
  std::map<std::uint32_t, Caption> things;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const auto& p = scene.points[i];
    if (p.label == 0 || scene.things[i] == 0)
      continue;
    const Eigen::Vector3d at = p.getVector3fMap().cast<double>();
    Caption& c = things[scene.things[i]];
    c.top = c.points == 0 ? at.dot(up) : std::max(c.top, at.dot(up));
    c.label = p.label;
    c.at += at;
    ++c.points;
  }
  std::vector<Caption> captions;
  for (auto& [thing, c] : things) {
    c.at /= static_cast<double>(c.points);
    c.at += (c.top - c.at.dot(up)) * up;
    captions.push_back(c);
  }
  return captions;
}

void
addCaption(const Caption& caption, const Names& names, vtkRenderer& renderer)
{
  const auto name = caption.label <= names.size() ? names[caption.label - 1]
                                                  : "object " + std::to_string(caption.label);
  const auto text = vtkSmartPointer<vtkBillboardTextActor3D>::New();
  text->SetInput(name.c_str());
  text->SetPosition(caption.at.x(), caption.at.y(), caption.at.z());
  text->SetDisplayOffset(0, 10); // pixels
  auto* style = text->GetTextProperty();
  const Colour c = colourOf(caption.label);
  style->SetColor(0.6 * c[0] / 255, 0.6 * c[1] / 255, 0.6 * c[2] / 255);
  style->SetFontSize(22);
  style->SetBold(true);
  style->SetJustificationToCentered();
  style->SetVerticalJustificationToBottom();
  renderer.AddActor(text);
}

constexpr double kViewAngle = 30; ///< from the lower to the upper edge, degrees

/** \brief Where the eye is and what it looks at. */
struct Eye {
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();
  double distance = 0;
};

/** \brief Moves and turns the eye so that the points just fill the picture: each step is exact for
 * parallel rays, and a few suffice for those that meet. */
Eye
eyeThatSees(const pcl::PointCloud<pcl::PointXYZRGB>& cloud, const Directions& view, double aspect)
{
  constexpr int kSteps = 8;
  constexpr double kMargin = 1.14; // captions stand above things
  const double slope = std::tan(kViewAngle / 2 * kRadian) / kMargin;
  Eigen::Vector4f low, high;
  pcl::getMinMax3D(cloud, low, high);
  Eye eye;
  eye.focus = ((low + high) / 2).head<3>().cast<double>();
  eye.distance = std::max<double>((high - low).head<3>().norm(), 1e-6) / slope;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::AlignedBox2d seen;
    for (const auto& p : cloud) {
      const Eigen::Vector3d d = p.getVector3fMap().cast<double>() - eye.focus;
      const double depth = std::max(eye.distance - d.dot(view.to_eye), 0.01 * eye.distance);
      seen.extend(Eigen::Vector2d(d.dot(view.right), d.dot(view.up)) / depth);
    }
    const Eigen::Vector2d size = seen.sizes() / 2, middle = seen.center() * eye.distance;
    eye.focus += middle.x() * view.right + middle.y() * view.up;
    eye.distance *= std::max({size.x() / aspect, size.y(), 1e-6 * slope}) / slope;
  }
  return eye;
}

void
placeEye(const pcl::PointCloud<pcl::PointXYZRGB>& cloud, const PictureOptions& o,
         pcl::visualization::PCLVisualizer& viewer)
{
  const Directions view(o);
  const Eye eye = eyeThatSees(cloud, view, static_cast<double>(o.width) / o.height);
  const double distance = eye.distance / o.zoom;
  const Eigen::Vector3d at = eye.focus + distance * view.to_eye;
  viewer.setCameraPosition(at.x(), at.y(), at.z(), eye.focus.x(), eye.focus.y(), eye.focus.z(), 0,
                           0, 1);
  viewer.setCameraFieldOfView(kViewAngle * kRadian);
  viewer.setCameraClipDistances(distance / 100, 3 * distance);
}

/** \brief Drawn a little nearer to the eye than they are, so that what they lie on does not hide
 * them. */
void
addOverlay(const PictureOptions& o, pcl::visualization::PCLVisualizer& viewer)
{
  constexpr float kNearer = 0.01F, kDark = 0.1F;
  Eigen::Vector4f low, high;
  pcl::getMinMax3D(o.overlay, low, high);
  const Eigen::Vector3f shift =
      kNearer * (high - low).head<3>().norm() * eyeDirection(o).cast<float>();
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>);
  for (const auto& p : o.overlay) {
    const Eigen::Vector3f at = p.getVector3fMap() + shift;
    points->push_back({at.x(), at.y(), at.z()});
  }
  viewer.addPointCloud(points, "overlay");
  viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_COLOR, kDark, kDark,
                                          kDark, "overlay");
  viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE,
                                          o.point + 1, "overlay");
}

void
fill(const LabelledScene& scene, const Names& names, const PictureOptions& o,
     pcl::visualization::PCLVisualizer& viewer)
{
  const auto cloud = coloured(scene, o);
  viewer.setSize(o.width, o.height);
  viewer.setBackgroundColor(1, 1, 1);
  viewer.setShowFPS(false); // white on white, but over points it showed, and differed every time
  viewer.addPointCloud(cloud, "scene");
  viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, o.point,
                                          "scene");
  if (!o.overlay.empty())
    addOverlay(o, viewer);
  placeEye(*cloud, o, viewer);
  auto* renderer = viewer.getRendererCollection()->GetFirstRenderer();
  for (const auto& caption : captionsOf(scene, Directions(o).up))
    addCaption(caption, names, *renderer);
}

/** \brief VTK tells of its own deprecated functions. */
void
silenceVtk()
{
  vtkObject::GlobalWarningDisplayOff();
}

} // namespace

std::string
drawnScene(const LabelledScene& scene, const Names& names, const PictureOptions& options)
{
  silenceVtk();
  pcl::visualization::PCLVisualizer viewer("pcl_surflet_view", false);
  const auto window = viewer.getRenderWindow();
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(8);
  fill(scene, names, options, viewer);
  window->Render();
  // PCLVisualizer::saveScreenshot() of PCL 1.13 crashes without a window to interact with.
  const auto image = vtkSmartPointer<vtkWindowToImageFilter>::New();
  image->SetInput(window);
  image->ReadFrontBufferOff();
  const auto writer = vtkSmartPointer<vtkPNGWriter>::New();
  writer->SetInputConnection(image->GetOutputPort());
  writer->WriteToMemoryOn();
  writer->SetCompressionLevel(9);
  writer->Write();
  const auto* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

void
showScene(const LabelledScene& scene, const Names& names, const PictureOptions& options)
{
  silenceVtk();
  pcl::visualization::PCLVisualizer viewer("pcl_surflet_view");
  fill(scene, names, options, viewer);
  viewer.spin();
}

} // namespace apps
} // namespace pcl_surflet
