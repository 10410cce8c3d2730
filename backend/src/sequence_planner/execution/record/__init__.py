"""Events written down (`codec`, `recorder`), and states brought back from them (`replay`, `restore`)."""
