/** \file
 * Pictures of labelled scenes, drawn by pcl_surflet_view: a program of its own, so that no other
 * loads VTK's rendering. */
#pragma once

#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief Has pcl_surflet_view, which lies beside this program, draw \p labelled to \p picture, and
 * over it the points of the file \p overlay, unless it is empty.
 * \throws DataError if it cannot be run or fails; it has said why */
void drawPicture(const std::string& labelled, const std::string& database,
                 const std::string& picture, const std::string& overlay = "");

} // namespace apps
} // namespace pcl_surflet
