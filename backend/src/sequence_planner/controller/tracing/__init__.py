"""What is so and why: conditions down to the variables that decide them, and variables down to messages."""
