"""Several stations on one database, of which one commands the devices and the others stand by."""
