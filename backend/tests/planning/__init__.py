"""What the planner's parts say to people."""
