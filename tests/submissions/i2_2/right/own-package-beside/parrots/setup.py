from setuptools import setup

package_name = 'parrots'

setup(
    name=package_name,
    version='0.1.0',
    packages=[package_name],
    data_files=[('share/' + package_name, ['package.xml'])],
    entry_points={
        'console_scripts': [
            'teacher = parrots.birds:teach',
            f'parrot = {package_name}.birds:repeat',
        ],
    },
)
