"""The stages, one module for each family: their descriptions, their courses and how they are made from documents."""
