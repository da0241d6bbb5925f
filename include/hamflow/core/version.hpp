// Version of hamflow. A later minor version may change the interface until version 1.0; a later patch does not.
#pragma once

#define HAMFLOW_VERSION_MAJOR 0
#define HAMFLOW_VERSION_MINOR 2
#define HAMFLOW_VERSION_PATCH 0
/// The version as text, "MAJOR.MINOR.PATCH".
#define HAMFLOW_VERSION "0.2.0"
