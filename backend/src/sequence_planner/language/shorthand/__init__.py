"""What expressions say for short: names that stand for something longer, and values case by case."""
