"""The network around the controller: inputs, outputs, services and actions, and who else is there."""
