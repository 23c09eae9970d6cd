"""Every method driven to its edge."""
