/** The ROS graph. */
export const ros = {};
