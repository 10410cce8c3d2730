"""What tests of all packages have in common."""
